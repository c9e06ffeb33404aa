// The plain verdict on a fit.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "arx_report.hpp"

namespace wisp {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string percent(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f %%", value);
  return text;
}

// A one-step fit that promises this much more than free simulation keeps hides the model's failure.
constexpr double kPromise = 80;
constexpr double kKept = 60;

}  // namespace

void judge_fit(const FitFacts& facts, ArxSummary& summary) {
  summary.usable = {true, "all coefficients are determined by the data and the model is stable"};
  std::vector<std::string>& warnings = summary.warnings;
  for (const RankProblem& problem : summary.rank_problems) {
    if (std::find(warnings.begin(), warnings.end(), problem.reason) == warnings.end()) {
      warnings.push_back(problem.reason);
    }
  }
  if (summary.stable.changed) {
    warnings.push_back("the estimate was unstable (spectral radius " + number(summary.stable.estimated) +
                       ") and was made stable (" + number(summary.stable.radius) + "); the squared error grew by " +
                       percent(100 * (summary.stable.loss_factor - 1)));
  }
  for (int i = 0; i < static_cast<int>(summary.free_run_fit_percent.size()); ++i) {
    if (summary.fit_percent[i] < kPromise || summary.free_run_fit_percent[i] >= kKept) continue;
    warnings.push_back("output '" + facts.names[i] + "': one step ahead the fit is " + percent(summary.fit_percent[i]) +
                       ", but free simulation from the input fits only " + percent(summary.free_run_fit_percent[i]) +
                       "; judge this model by simulation, and try other orders or delays");
  }
  for (int i = 0; i < facts.outputs; ++i) {
    if (facts.scale[i] != 0) continue;
    summary.usable = {false, "output '" + facts.names[i] + "' never changes: there is nothing to learn"};
    return;
  }
  if (!summary.rank_problems.empty()) {
    summary.usable = {false, "the data cannot tell all coefficients: " + summary.rank_problems.front().reason};
  } else if (!(summary.stable.radius < 1)) {
    summary.usable = {false, "the model is unstable: spectral radius " + number(summary.stable.radius)};
  }
}

}  // namespace wisp
