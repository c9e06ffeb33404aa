#include "learn/arx/fit/arx_fit.hpp"

#include <algorithm>
#include <cmath>

#include "learn/arx/fit/arx_check.hpp"
#include "learn/arx/fit/arx_estimate.hpp"
#include "learn/arx/fit/arx_report.hpp"
#include "learn/arx/fit/given_rows.hpp"
#include "learn/arx/judge/prediction_tally.hpp"
#include "learn/arx/rows/arx_design.hpp"
#include "learn/arx/rows/arx_rows.hpp"

namespace wisp {

namespace {

using Eigen::Index;

// What one scaled coefficient is in the data's units.
double unit_of(const Signals& signals, int output, const LaggedChannel& column) {
  const double own = inverse_or_zero(signals.scale[output]);
  return column.channel == kConstantChannel ? own : own * signals.scale[column.channel];
}

// A's coefficients stand on the left side of the equation.
double sign_of(const Signals& signals, const LaggedChannel& column) {
  return column.channel != kConstantChannel && column.channel < signals.outputs ? -1.0 : 1.0;
}

void give_rows(const ArxDesign& design, const std::vector<GivenRow>& rows, ArxEstimate& estimate) {
  for (std::size_t g = 0; g < design.groups.size(); ++g) {
    const SharedRows& group = design.groups[g];
    for (std::size_t k = 0; k < group.outputs.size(); ++k) {
      const GivenRow& row = rows[std::size_t(group.outputs[k])];
      estimate.groups[g].theta.col(Index(k)) = row.theta;
      if (row.effective == 0) continue;
      estimate.effective[g] = row.effective;
      estimate.groups[g].dependent.clear();
    }
  }
  estimate.residual_gram = estimate.residual_gram_at(estimate.thetas());
}

void give_errors(const Signals& signals, const ArxOptions& options, const std::vector<GivenRow>& rows,
                 const ArxFit& plain, ArxFit& fit) {
  const ArxModel& model = fit.model;
  Index joint = 0, start = 0;
  for (const auto& row : model.theta) joint += Index(row.size());
  for (int i = 0; i < signals.outputs; ++i) {
    const auto columns = row_regressors(model.orders, i, options.offset);
    const auto size = Index(model.theta[std::size_t(i)].size());
    const Eigen::MatrixXd& own = rows[std::size_t(i)].covariance;
    if (own.size() == 0) fit.model.std_error[std::size_t(i)] = plain.model.std_error[std::size_t(i)];
    for (Index p = 0; own.size() > 0 && p < size; ++p) {
      const double unit = unit_of(signals, i, columns[std::size_t(p)]);
      fit.model.std_error[std::size_t(i)][std::size_t(p)] = std::sqrt(std::max(own(p, p), 0.0)) * unit;
      for (Index q = 0; !fit.covariance.empty() && q < joint; ++q) {
        const bool inside = q >= start && q < start + size;
        double value = 0;
        if (inside) {
          const LaggedChannel& a = columns[std::size_t(p)];
          const LaggedChannel& b = columns[std::size_t(q - start)];
          value = own(p, q - start) * unit * unit_of(signals, i, b) * sign_of(signals, a) * sign_of(signals, b);
        }
        fit.covariance[std::size_t((start + p) * joint + q)] = value;
        fit.covariance[std::size_t(q * joint + start + p)] = value;
      }
    }
    start += size;
  }
}

Result<ArxFit> fit_as(std::span<const Recording> recordings, const ChannelChoice& channels, const ArxOptions& options,
                      const std::vector<GivenRow>* rows, const ArxFit* plain) {
  if (auto ok = check_options(options, channels); !ok) return ok.error();
  const auto signals = gather_signals(recordings, channels, options.offset);
  if (!signals) return signals.error();
  const ArxDesign design = make_design(options.orders, options.offset, options.kernel != ArxKernel::kNone);
  const RowPlan plan = plan_rows(*signals, design.layout, options.first_sample.value_or(options.orders.history()));
  if (auto ok = check_rows(plan, design); !ok) return ok.error();

  const FitFacts facts{options,   signals->outputs,  signals->names,     signals->offset,       signals->scale,
                       plan.rows, plan.first_sample, plan.episodes_used, plan.episodes_skipped, plan.rows_left_out};
  ArxEstimate estimate =
      estimate_from_data(*signals, plan, design, {options.ridge, options.covariance, options.kernel});
  if (rows) give_rows(design, *rows, estimate);
  ArxFit fit = report_fit(facts, design, std::move(estimate));
  if (rows) give_errors(*signals, options, *rows, *plain, fit);
  const bool driven = std::any_of(options.orders.nb.values().begin(), options.orders.nb.values().end(),
                                  [](int order) { return order > 0; });
  if (options.judge_free_run && driven) {
    const Tally tally = free_run_tally(fit.model, *signals, 1, InitialState::kMeasured, options.orders.history());
    fit.summary.free_run_fit_percent = tally.figures(kFreeRun).fit_percent;
  }
  judge_fit(facts, fit.summary);
  return fit;
}

}  // namespace

Result<ArxFit> fit_arx(std::span<const Recording> recordings, const ChannelChoice& channels,
                       const ArxOptions& options) {
  return fit_as(recordings, channels, options, nullptr, nullptr);
}

GivenRow row_of_model(const ArxModel& model, int output, const Signals& signals, ArxOffset offset) {
  const auto columns = row_regressors(model.orders, output, offset);
  GivenRow row{Eigen::VectorXd(Index(columns.size())), {}};
  for (std::size_t p = 0; p < columns.size(); ++p) {
    const bool constant = columns[p].channel == kConstantChannel;
    const double value = constant ? model.constant[std::size_t(output)] : model.theta[std::size_t(output)][p];
    row.theta[Index(p)] = sign_of(signals, columns[p]) * value * inverse_or_zero(unit_of(signals, output, columns[p]));
  }
  return row;
}

Result<ArxFit> fit_with_rows(std::span<const Recording> recordings, const ChannelChoice& channels,
                             const ArxOptions& options, const std::vector<GivenRow>& rows, const ArxFit& plain) {
  return fit_as(recordings, channels, options, &rows, &plain);
}

}  // namespace wisp
