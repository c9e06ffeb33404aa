// The plain verdict on a fit.

#include <algorithm>

#include "learn/arx/fit/arx_report.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace {

std::string percent(double value) { return value > -1000 ? number_text(value, 3) + " %" : "nothing: it diverges"; }

// A one-step fit that promises this much more than free simulation keeps hides the model's failure.
constexpr double kPromise = 80, kKept = 60;

}  // namespace

void warn_of_free_run(const std::vector<std::string>& outputs, ArxSummary& summary) {
  for (std::size_t i = 0; i < summary.free_run_fit_percent.size(); ++i) {
    const double one_step = summary.fit_percent[i], free_run = summary.free_run_fit_percent[i];
    if (one_step < kPromise || free_run >= kKept) continue;
    summary.warnings.push_back("output '" + outputs[i] + "': one step ahead the fit is " + percent(one_step) +
                               ", but free simulation from the input fits " + (free_run > -1000 ? "only " : "") +
                               percent(free_run) + "; judge this model by simulation, and try other orders or delays");
  }
}

void judge_fit(const FitFacts& facts, ArxSummary& summary) {
  summary.usable = {true, "all coefficients are determined by the data and the model is stable"};
  std::vector<std::string>& warnings = summary.warnings;
  for (const RankProblem& problem : summary.rank_problems) {
    if (std::find(warnings.begin(), warnings.end(), problem.reason) == warnings.end())
      warnings.push_back(problem.reason);
  }
  if (summary.stable.changed) {
    warnings.push_back("the estimate was unstable (spectral radius " + number_text(summary.stable.estimated, 4) +
                       ") and was made stable (" + number_text(summary.stable.radius, 4) +
                       "); the squared one-step error grew by " +
                       number_text(100 * (summary.stable.loss_factor - 1), 2) +
                       " %; stability alone moves no coefficient by more than " + number_text(summary.stable.moved, 2) +
                       " standard errors");
  }
  warn_of_free_run(facts.names, summary);
  for (int i = 0; i < facts.outputs; ++i) {
    if (facts.scale[i] != 0) continue;
    summary.usable = {false, "output '" + facts.names[i] + "' never changes: there is nothing to learn"};
    return;
  }
  if (!summary.rank_problems.empty()) {
    summary.usable = {false, "the data cannot tell all coefficients: " + summary.rank_problems.front().reason};
  } else if (!(summary.stable.radius < 1)) {
    summary.usable = {false, "the model is unstable: spectral radius " + number_text(summary.stable.radius, 4)};
  }
}

}  // namespace wisp
