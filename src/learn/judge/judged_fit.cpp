#include "learn/judge/judged_fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "learn/fit/arx_estimate.hpp"
#include "learn/fit/arx_report.hpp"
#include "learn/judge/prediction.hpp"
#include "learn/rows/arx_design.hpp"
#include "learn/rows/arx_rows.hpp"

namespace wisp {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Imposes the constraint Cθ = d on least squares by Lagrange multipliers: θ − P Cᵀ(C P Cᵀ)⁻¹(Cθ − d). The first row of
// C makes A_ii zero at the pole, the second row makes the derivative of A_ii zero there.
void hold_integrators(const ArxOptions& options, const ArxDesign& design, ArxEstimate& estimate) {
  for (std::size_t g = 0; g < design.groups.size(); ++g) {
    const SharedRows& rows = design.groups[g];
    const int output = rows.outputs.front(), count = options.integrators[std::size_t(output)];
    if (count == 0) continue;
    SharedSolution& solution = estimate.groups[g];
    MatrixXd c = MatrixXd::Zero(count, solution.theta.rows());
    for (std::size_t p = 0; p < rows.columns.size(); ++p) {
      const LaggedChannel column = design.layout[rows.columns[p]];
      if (column.channel != output) continue;
      const double power = std::pow(options.integrator_pole, -column.lag);
      for (int k = 0; k < count; ++k) c(k, static_cast<Index>(p)) = k == 0 ? power : power * column.lag;
    }
    VectorXd d = VectorXd::Zero(count);
    d[0] = 1;
    const MatrixXd gain = solution.inverse * c.transpose() * (c * solution.inverse * c.transpose()).inverse();
    solution.theta -= gain * (c * solution.theta - d);
    solution.inverse -= (gain * c * solution.inverse).eval();
    solution.inverse.diagonal() = solution.inverse.diagonal().cwiseMax(0);
    estimate.effective[g] -= count;
  }
  estimate.residual_gram = estimate.residual_gram_at(estimate.thetas());
}

// Fit percentages of free simulation over the training rows, in double precision or as the stored model is played.
std::vector<double> free_run_fits(const ArxModel& model, const Signals& signals, bool as_played) {
  const FreeRunStart start{InitialState::kMeasured, model.orders.history(), as_played};
  return free_run_tally(model, signals, start).figures(kFreeRun).fit_percent;
}

// Moves the poles of an unstable estimate further inwards, to the best of five shares of the maximum radius, where that
// improves free simulation of the judged rows: the effect of an error in a pole near the limit decays slowly.
ArxFit drawn_in(FitFacts facts, const ArxDesign& design, const ArxEstimate& estimate, const Signals& judged,
                ArxFit fit) {
  constexpr double kNothing = -100, kGain = 1;  // percent: floor of an output's fit; minimum gain of the sum of fits
  const auto sum = [&](const ArxFit& one) {
    double all = 0;
    for (double percent : free_run_fits(one.model, judged, false)) all += std::max(percent, kNothing);
    return all;
  };
  const double moved = fit.summary.stable.moved;
  double best = sum(fit);
  for (const double share : {0.99, 0.97, 0.95, 0.9, 0.8}) {
    facts.drawn_in = share;
    ArxFit farther = report_fit(facts, design, estimate);
    const double fits = sum(farther);
    if (!(fits > best + kGain)) continue;
    best = fits;
    fit = std::move(farther);
  }
  fit.summary.stable.moved = moved;
  return fit;
}

}  // namespace

Result<ArxFit> fit_arx(std::span<const Recording> recordings, const ChannelChoice& channels,
                       const ArxOptions& options) {
  if (auto ok = check_options(options, channels); !ok) return ok.error();
  const auto signals = gather_signals(recordings, channels, options.offset);
  if (!signals) return signals.error();
  const ArxDesign design =
      make_design(options.orders, options.offset, options.kernel != ArxKernel::kNone || !options.integrators.empty());
  const RowPlan plan = plan_rows(*signals, design.layout, options.orders.history());
  if (auto ok = check_rows(plan, design); !ok) return ok.error();

  const FitFacts facts{plan, options, signals->outputs, signals->names, signals->offset, signals->scale};
  ArxEstimate estimate =
      estimate_from_data(*signals, plan, design, {options.covariance, options.kernel, options.kernel_outputs});
  if (!options.integrators.empty()) hold_integrators(options, design, estimate);
  ArxFit fit = report_fit(facts, design, estimate);
  const bool driven = std::any_of(options.orders.nb.values().begin(), options.orders.nb.values().end(),
                                  [](int order) { return order > 0; });
  if (driven && (options.judge_free_run || fit.summary.stable.changed)) {
    const Signals judged = middle_of(*signals, kJudgedRows);
    if (fit.summary.stable.changed) fit = drawn_in(facts, design, estimate, judged, std::move(fit));
    fit.summary.free_run_fit_percent = free_run_fits(fit.model, judged, false);
    fit.summary.played_fit_percent = free_run_fits(fit.model, judged, true);
  }
  judge_fit(facts, fit.summary);
  return fit;
}

}  // namespace wisp
