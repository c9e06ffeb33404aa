#include "learn/arx/fit/arx_fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "learn/arx/fit/arx_check.hpp"
#include "learn/arx/fit/arx_estimate.hpp"
#include "learn/arx/fit/arx_report.hpp"
#include "learn/arx/judge/prediction_tally.hpp"
#include "learn/arx/rows/arx_design.hpp"
#include "learn/arx/rows/arx_rows.hpp"

namespace wisp {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Least squares under Cθ = d, by Lagrange: θ − P Cᵀ(C P Cᵀ)⁻¹(Cθ − d). A row of C says that A_ii is zero at the pole,
// the next that its derivative is.
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

  const FitFacts facts{options,   signals->outputs,  signals->names,     signals->offset,       signals->scale,
                       plan.rows, plan.first_sample, plan.episodes_used, plan.episodes_skipped, plan.rows_left_out};
  ArxEstimate estimate =
      estimate_from_data(*signals, plan, design, {options.covariance, options.kernel, options.kernel_outputs});
  if (!options.integrators.empty()) hold_integrators(options, design, estimate);
  ArxFit fit = report_fit(facts, design, std::move(estimate));
  const bool driven = std::any_of(options.orders.nb.values().begin(), options.orders.nb.values().end(),
                                  [](int order) { return order > 0; });
  if (options.judge_free_run && driven) {
    const Signals judged = middle_of(*signals, kJudgedRows);
    const auto fits = [&](bool as_played) {
      const FreeRunStart start{InitialState::kMeasured, options.orders.history(), as_played};
      return free_run_tally(fit.model, judged, start).figures(kFreeRun).fit_percent;
    };
    fit.summary.free_run_fit_percent = fits(false);
    fit.summary.played_fit_percent = fits(true);
  }
  judge_fit(facts, fit.summary);
  return fit;
}

}  // namespace wisp
