#include "wisp/learn/arx_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "arx_rows.hpp"
#include "arx_solve.hpp"
#include "arx_triangle.hpp"

namespace wisp {
namespace {

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g", value);
  return buffer;
}

Result<void> check_shapes(const ArxOrders& orders, const ChannelChoice& channels) {
  const auto ny = static_cast<int>(channels.outputs.size());
  const auto nu = static_cast<int>(channels.inputs.size());
  const auto shape = [](const OrderMatrix& matrix) {
    return std::to_string(matrix.rows()) + " × " + std::to_string(matrix.columns());
  };
  const auto wrong = [&](const char* name, const OrderMatrix& matrix, int rows, int columns) {
    return Error{std::string(name) + " is " + shape(matrix) + ", expected " + std::to_string(rows) + " × " +
                 std::to_string(columns) + " for " + std::to_string(ny) + " outputs and " + std::to_string(nu) +
                 " inputs"};
  };
  if (orders.na.rows() != ny || orders.na.columns() != ny) return wrong("na", orders.na, ny, ny);
  if (nu == 0) return {};
  if (orders.nb.rows() != ny || orders.nb.columns() != nu) return wrong("nb", orders.nb, ny, nu);
  if (orders.nk.rows() != ny || orders.nk.columns() != nu) return wrong("nk", orders.nk, ny, nu);
  return {};
}

Result<void> check_options(const ArxOptions& options) {
  for (const OrderMatrix* matrix : {&options.orders.na, &options.orders.nb, &options.orders.nk}) {
    for (int order : matrix->values()) {
      if (order < 0 || order > 4096) return Error{"an order is " + std::to_string(order) + ", expected 0 to 4096"};
    }
  }
  if (!(options.ridge >= 0) || !std::isfinite(options.ridge)) return Error{"the ridge must be 0 or more"};
  if (!(options.stability_margin > 0 && options.stability_margin < 1)) {
    return Error{"the stability margin must lie between 0 and 1"};
  }
  if (options.first_sample && *options.first_sample < options.orders.history()) {
    return Error{"the first sample is " + std::to_string(*options.first_sample) + ", but the longest lag is " +
                 std::to_string(options.orders.history())};
  }
  return {};
}

// Regressors of output row i, in theta's order; the constant comes last.
std::vector<LaggedChannel> regressors(const ArxOrders& orders, int i, ArxOffset offset) {
  std::vector<LaggedChannel> columns;
  for (int j = 0; j < orders.outputs(); ++j) {
    for (int lag = 1; lag <= orders.na(i, j); ++lag) columns.push_back({j, lag});
  }
  for (int k = 0; k < orders.inputs(); ++k) {
    for (int lag = 0; lag < orders.nb(i, k); ++lag) columns.push_back({orders.outputs() + k, orders.nk(i, k) + lag});
  }
  if (offset == ArxOffset::kEstimate) columns.push_back({kConstantChannel, 0});
  return columns;
}

std::vector<LaggedChannel> all_regressors(const ArxOrders& orders, ArxOffset offset) {
  std::vector<LaggedChannel> all;
  for (int i = 0; i < orders.outputs(); ++i) {
    for (const LaggedChannel& column : regressors(orders, i, offset)) {
      if (std::find(all.begin(), all.end(), column) == all.end()) all.push_back(column);
    }
  }
  return all;
}

// Everything about one fit while it is made.
struct Work {
  const ArxOptions& options;
  Signals signals;
  std::vector<LaggedChannel> columns;
  RowPlan plan;
  Eigen::MatrixXd triangle;
  std::vector<std::vector<LaggedChannel>> row_columns;
  std::vector<RowSolution> rows;
  Eigen::MatrixXd residual;  // triangle · [−θ; 1], one column an output: its Gram is that of the residuals
};

double scale_of(const Signals& signals, int channel) {
  return channel == kConstantChannel ? 1.0 : signals.scale[channel];
}

double inverse_or_zero(double value) { return value == 0 ? 0.0 : 1.0 / value; }

Result<void> check_rows(const Work& work) {
  std::size_t most = 0;
  for (const auto& columns : work.row_columns) most = std::max(most, columns.size());
  if (work.plan.rows == 0) {
    return Error{"no row can be predicted: the longest lag is " + std::to_string(work.plan.first_sample) +
                 " samples and no episode has more rows without gaps (" + std::to_string(work.plan.episodes_skipped) +
                 " episodes skipped); use lower orders or delays"};
  }
  if (work.plan.rows <= most) {
    return Error{std::to_string(most) + " coefficients an output cannot be learned from " +
                 std::to_string(work.plan.rows) + " rows; use lower orders or a longer recording"};
  }
  return {};
}

void solve_rows(Work& work) {
  const auto ny = work.signals.outputs;
  work.residual = work.triangle.rightCols(ny);
  for (int i = 0; i < ny; ++i) {
    RowProblem problem{work.triangle, {}, static_cast<int>(work.columns.size()) + i, {}, work.options.ridge};
    problem.unit.resize(static_cast<Eigen::Index>(work.row_columns[i].size()));
    for (std::size_t p = 0; p < work.row_columns[i].size(); ++p) {
      const auto found = std::find(work.columns.begin(), work.columns.end(), work.row_columns[i][p]);
      problem.regressors.push_back(static_cast<int>(found - work.columns.begin()));
      problem.unit[static_cast<Eigen::Index>(p)] =
          inverse_or_zero(scale_of(work.signals, work.row_columns[i][p].channel));
    }
    RowSolution solution = solve_row(problem);
    for (std::size_t p = 0; p < problem.regressors.size(); ++p) {
      work.residual.col(i) -= solution.theta[static_cast<Eigen::Index>(p)] * work.triangle.col(problem.regressors[p]);
    }
    work.rows.push_back(std::move(solution));
  }
}

// Coefficients and standard errors from scaled units, with A's sign.
void write_row(const Work& work, int i, ArxModel& model) {
  const RowSolution& row = work.rows[i];
  const auto& columns = work.row_columns[i];
  const double own = inverse_or_zero(work.signals.scale[i]);
  const double n = static_cast<double>(work.plan.rows);
  const double variance = work.residual.col(i).squaredNorm() / (n - static_cast<double>(columns.size()));
  for (std::size_t p = 0; p < columns.size(); ++p) {
    const auto index = static_cast<Eigen::Index>(p);
    const double unit = own * scale_of(work.signals, columns[p].channel);
    if (columns[p].channel == kConstantChannel) {
      model.constant[i] = row.theta[index] * unit;
      continue;
    }
    const double sign = columns[p].channel < work.signals.outputs ? -1.0 : 1.0;
    model.theta[i].push_back(sign * row.theta[index] * unit);
    model.std_error[i].push_back(std::sqrt(variance * row.inverse(index, index)) * unit);
  }
}

ArxModel write_model(const Work& work) {
  const int ny = work.signals.outputs;
  ArxModel model;
  model.orders = work.options.orders;
  model.theta.resize(ny);
  model.std_error.resize(ny);
  model.constant.assign(ny, 0.0);
  model.output_mean.assign(work.signals.offset.begin(), work.signals.offset.begin() + ny);
  model.input_mean.assign(work.signals.offset.begin() + ny, work.signals.offset.end());
  for (int i = 0; i < ny; ++i) write_row(work, i, model);
  return model;
}

// Mean products of residuals, in the data's units.
std::vector<double> noise_covariance(const Work& work) {
  const int ny = work.signals.outputs;
  const Eigen::MatrixXd gram = work.residual.transpose() * work.residual / static_cast<double>(work.plan.rows);
  std::vector<double> covariance;
  for (int i = 0; i < ny; ++i) {
    for (int j = 0; j < ny; ++j) {
      covariance.push_back(gram(i, j) * inverse_or_zero(work.signals.scale[i]) *
                           inverse_or_zero(work.signals.scale[j]));
    }
  }
  return covariance;
}

// ln det by way of correlations, so that units do not over- or underflow it.
double log_determinant(const std::vector<double>& covariance, int ny) {
  Eigen::MatrixXd correlation(ny, ny);
  double log = 0;
  for (int i = 0; i < ny; ++i) log += std::log(covariance[static_cast<std::size_t>(i) * ny + i]);
  for (int i = 0; i < ny; ++i) {
    for (int j = 0; j < ny; ++j) {
      correlation(i, j) = covariance[static_cast<std::size_t>(i) * ny + j] /
                          std::sqrt(covariance[static_cast<std::size_t>(i) * ny + i] *
                                    covariance[static_cast<std::size_t>(j) * ny + j]);
    }
  }
  return log + Eigen::LDLT<Eigen::MatrixXd>(correlation).vectorD().array().log().sum();
}

void write_criteria(const Work& work, ArxSummary& summary) {
  const int ny = work.signals.outputs;
  const double n = static_cast<double>(work.plan.rows);
  double total = 0;
  for (const auto& columns : work.row_columns) total += static_cast<double>(columns.size());
  const double per_output = total / ny;
  const double log_det = log_determinant(summary.noise_covariance, ny);
  summary.fpe = std::exp(log_det) * (1 + per_output / n) / (1 - per_output / n);
  summary.fpe_total = std::exp(log_det) * (1 + total / n) / (1 - total / n);
  summary.aic = n * log_det + 2 * total;
  summary.aicc = summary.aic + 2 * total * (total + 1) / (n - total - 1);
  summary.bic = n * log_det + total * std::log(n);
  for (int i = 0; i < ny; ++i) {
    const double d = static_cast<double>(work.row_columns[i].size());
    summary.row_fpe.push_back(summary.loss[i] * (1 + d / n) / (1 - d / n));
  }
}

double target_variance(const Work& work, int output) {
  double sum = 0;
  double square = 0;
  for (const RowRun& run : work.plan.runs) {
    std::vector<double> samples(run.end - run.begin);
    copy_scaled(work.signals, run.recording, output, run.begin, run.end, samples.data());
    for (double sample : samples) sum += sample, square += sample * sample;
  }
  const double n = static_cast<double>(work.plan.rows);
  const double unit = inverse_or_zero(work.signals.scale[output]);
  return (square / n - (sum / n) * (sum / n)) * unit * unit;
}

std::string lag_text(const Work& work, const LaggedChannel& column) {
  if (column.channel == kConstantChannel) return "the constant";
  return "'" + work.signals.names[column.channel] + "' at lag " + std::to_string(column.lag);
}

void name_rank_problems(const Work& work, ArxSummary& summary) {
  for (int i = 0; i < work.signals.outputs; ++i) {
    for (const DependentColumn& dependent : work.rows[i].dependent) {
      const LaggedChannel& column = work.row_columns[i][dependent.column];
      RankProblem problem;
      problem.row = i;
      problem.lag = column.lag;
      problem.channel = column.channel == kConstantChannel ? "constant" : work.signals.names[column.channel];
      problem.reason = lag_text(work, column);
      if (dependent.of.empty()) {
        problem.reason += " is constant: it does not excite the system";
      } else {
        problem.reason += " is a combination of ";
        for (std::size_t k = 0; k < dependent.of.size(); ++k) {
          problem.reason += (k ? ", " : "") + lag_text(work, work.row_columns[i][dependent.of[k]]);
        }
      }
      summary.rank_problems.push_back(std::move(problem));
    }
  }
}

// 95 % interval of a standard deviation with `freedom` degrees of freedom: chi-squared quantiles by Wilson and
// Hilferty.
std::array<double, 2> sd_interval(double sd, double freedom) {
  const auto quantile = [&](double z) {
    const double root = 1 - 2 / (9 * freedom) + z * std::sqrt(2 / (9 * freedom));
    return freedom * root * root * root;
  };
  return {sd * std::sqrt(freedom / quantile(1.959963985)),
          sd * std::sqrt(freedom / std::max(quantile(-1.959963985), 1e-9))};
}

void write_noise(const Work& work, const ArxSummary& summary, ArxModel& model) {
  const double n = static_cast<double>(work.plan.rows);
  for (int i = 0; i < work.signals.outputs; ++i) {
    const double freedom = n - static_cast<double>(work.row_columns[i].size());
    const double sd = std::sqrt(summary.loss[i] * n / freedom);
    model.noise.sd.push_back(sd);
    model.noise.sd_ci95.push_back(sd_interval(sd, freedom));
  }
}

// Pulls all poles inwards by the same factor.
void scale_poles(ArxModel& model, double factor) {
  for (int i = 0; i < model.orders.outputs(); ++i) {
    std::size_t at = 0;
    for (int j = 0; j < model.orders.outputs(); ++j) {
      double power = factor;
      for (int lag = 0; lag < model.orders.na(i, j); ++lag, power *= factor) model.theta[i][at++] *= power;
    }
  }
}

void make_stable(Work& work, ArxModel& model, ArxSummary& summary) {
  summary.stable.radius = summary.stable.estimated = spectral_radius(model);
  if (!work.options.stabilise) return;
  while (summary.stable.radius >= 1.0) {
    const double factor = (1 - work.options.stability_margin) / summary.stable.radius;
    scale_poles(model, factor);
    summary.stable.changed = true;
    summary.stable.radius = spectral_radius(model);
  }
  if (!summary.stable.changed) return;
  for (int i = 0; i < work.signals.outputs; ++i) {
    work.residual.col(i) = work.triangle.col(static_cast<Eigen::Index>(work.columns.size()) + i);
    std::size_t at = 0;
    for (const LaggedChannel& column : work.row_columns[i]) {
      const auto found = std::find(work.columns.begin(), work.columns.end(), column) - work.columns.begin();
      const bool constant = column.channel == kConstantChannel;
      const double sign = !constant && column.channel < work.signals.outputs ? -1.0 : 1.0;
      const double theta = constant ? model.constant[i] : model.theta[i][at++];
      const double unit = inverse_or_zero(scale_of(work.signals, column.channel)) * work.signals.scale[i];
      work.residual.col(i) -= sign * theta * unit * work.triangle.col(found);
    }
  }
}

void judge(const Work& work, ArxSummary& summary) {
  summary.usable = {true, "all coefficients are determined by the data and the model is stable"};
  for (const RankProblem& problem : summary.rank_problems) summary.warnings.push_back(problem.reason);
  if (summary.stable.changed) {
    summary.warnings.push_back("the estimate was unstable (spectral radius " + text(summary.stable.estimated) +
                               ") and was made stable");
  }
  for (int i = 0; i < work.signals.outputs; ++i) {
    if (work.signals.scale[i] != 0) continue;
    summary.usable = {false, "output '" + work.signals.names[i] + "' never changes: there is nothing to learn"};
    return;
  }
  if (!summary.rank_problems.empty()) {
    summary.usable = {false, "the data cannot tell all coefficients: " + summary.rank_problems.front().reason};
  } else if (summary.stable.radius >= 1) {
    summary.usable = {false, "the model is unstable: spectral radius " + text(summary.stable.radius)};
  }
}

ArxFit finish(Work& work) {
  ArxFit fit;
  ArxSummary& summary = fit.summary;
  fit.model = write_model(work);
  const std::vector<double> free = noise_covariance(work);
  make_stable(work, fit.model, summary);
  summary.noise_covariance = noise_covariance(work);
  double log_factor = 0;
  const int ny = work.signals.outputs;
  for (int i = 0; i < ny; ++i) {
    const std::size_t diagonal = static_cast<std::size_t>(i) * ny + i;
    summary.loss.push_back(summary.noise_covariance[diagonal]);
    if (free[diagonal] > 0) log_factor += std::log(summary.loss[i] / free[diagonal]) / ny;
    const double variance = target_variance(work, i);
    summary.fit_percent.push_back(variance > 0 ? 100 * (1 - std::sqrt(summary.loss[i] / variance)) : 0);
    summary.condition.push_back(work.rows[i].condition);
  }
  summary.stable.loss_factor = std::exp(log_factor);
  write_criteria(work, summary);
  write_noise(work, summary, fit.model);
  summary.samples_used = work.plan.rows;
  summary.first_sample = work.plan.first_sample;
  summary.episodes_used = work.plan.episodes_used;
  summary.episodes_skipped = work.plan.episodes_skipped;
  summary.rows_left_out = work.plan.rows_left_out;
  summary.method = "Householder QR by blocks of rows";
  name_rank_problems(work, summary);
  judge(work, summary);
  return fit;
}

}  // namespace

Result<ArxFit> fit_arx(std::span<const Recording> recordings, const ChannelChoice& channels,
                       const ArxOptions& options) {
  if (auto ok = check_shapes(options.orders, channels); !ok) return ok.error();
  if (auto ok = check_options(options); !ok) return ok.error();
  auto signals = gather_signals(recordings, channels, options.offset);
  if (!signals) return signals.error();
  Work work{options, std::move(*signals), all_regressors(options.orders, options.offset), {}, {}, {}, {}, {}};
  for (int i = 0; i < work.signals.outputs; ++i) {
    work.row_columns.push_back(regressors(options.orders, i, options.offset));
  }
  work.plan = plan_rows(work.signals, lags_in_use(work.signals, work.columns),
                        options.first_sample.value_or(options.orders.history()));
  if (auto ok = check_rows(work); !ok) return ok.error();
  work.triangle = triangle_by_qr(work.signals, work.plan, work.columns);
  solve_rows(work);
  return finish(work);
}

}  // namespace wisp
