#include "learn/arx/fit/arx_fit.hpp"

#include <algorithm>

#include "learn/arx/fit/arx_check.hpp"
#include "learn/arx/fit/arx_estimate.hpp"
#include "learn/arx/fit/arx_report.hpp"
#include "learn/arx/judge/prediction_tally.hpp"
#include "learn/arx/rows/arx_design.hpp"
#include "learn/arx/rows/arx_rows.hpp"

namespace wisp {

Result<ArxFit> fit_arx(std::span<const Recording> recordings, const ChannelChoice& channels,
                       const ArxOptions& options) {
  if (auto ok = check_options(options, channels); !ok) return ok.error();
  const auto signals = gather_signals(recordings, channels, options.offset);
  if (!signals) return signals.error();
  const ArxDesign design = make_design(options.orders, options.offset, options.kernel != ArxKernel::kNone);
  const RowPlan plan = plan_rows(*signals, design.layout, options.first_sample.value_or(options.orders.history()));
  if (auto ok = check_rows(plan, design); !ok) return ok.error();

  const FitFacts facts{options,   signals->outputs,  signals->names,     signals->offset,       signals->scale,
                       plan.rows, plan.first_sample, plan.episodes_used, plan.episodes_skipped, plan.rows_left_out};
  ArxEstimate estimate = estimate_from_data(
      *signals, plan, design, {options.ridge, options.covariance, options.kernel, options.kernel_outputs});
  ArxFit fit = report_fit(facts, design, std::move(estimate));
  const bool driven = std::any_of(options.orders.nb.values().begin(), options.orders.nb.values().end(),
                                  [](int order) { return order > 0; });
  if (options.judge_free_run && driven) {
    const Tally tally = free_run_tally(fit.model, *signals, 1, InitialState::kMeasured, options.orders.history());
    fit.summary.free_run_fit_percent = tally.figures(kFreeRun).fit_percent;
  }
  judge_fit(facts, fit.summary);
  return fit;
}

}  // namespace wisp
