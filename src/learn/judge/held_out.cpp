#include "learn/judge/held_out.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics.hpp"
#include "learn/fit/arx_errors.hpp"
#include "learn/judge/judged_fit.hpp"

namespace wisp::arx {
namespace {

constexpr double kMaxError = 1e6;  // standard deviations: bounds errors that diverge, so that sums stay finite

// Measured samples and simulation errors of one output over all recordings; NaN where missing.
struct Series {
  std::vector<double> measured;
  std::vector<double> error;
};

// Standard deviation; 0 where the variation is rounding. Samples are normalised first, so squares never underflow.
double deviation_of(std::vector<double> measured) {
  constexpr double kStill = 1e-9;  // as a share of the mean: a smaller maximum deviation is rounding
  measured = present(std::move(measured));
  const double level = mean(measured);
  double most = 0;
  for (double y : measured) most = std::max(most, std::abs(y - level));
  if (!(most > kStill * std::abs(level))) return 0;
  for (double& y : measured) y = (y - level) / most;
  return most * deviation(measured);
}

// Mean squared error over variance of one output in each of kParts parts; the overall mean in a part without rows.
Eigen::VectorXd parts_of(const Series& one) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(kParts), rows = sum;
  const double deviation = deviation_of(one.measured);
  if (deviation == 0) return sum;
  for (std::size_t t = 0; t < one.error.size(); ++t) {
    if (std::isnan(one.measured[t]) || std::isnan(one.error[t])) continue;
    const double size = std::min(std::abs(one.error[t]) / deviation, kMaxError);
    const auto part = static_cast<Eigen::Index>(t * kParts / one.error.size());
    sum[part] += size * size;
    ++rows[part];
  }
  const double mean = sum.sum() / std::max(rows.sum(), 1.0);
  return (rows.array() > 0).select(sum.array() / rows.array().max(1), mean);
}

}  // namespace

std::vector<Fold> folds_of(std::span<const Recording> recordings) {
  std::vector<Fold> folds;
  for (double share : {0.4, 0.6, 0.8}) {
    Fold& fold = folds.emplace_back();
    for (const Recording& one : recordings) {
      const auto rows = static_cast<double>(one.rows());
      const auto cut = static_cast<std::size_t>(std::lround(share * rows));
      fold.learned.push_back(slice(one, 0, cut));
      fold.held_out.push_back(slice(one, cut, static_cast<std::size_t>(std::lround((share + 0.2) * rows))));
    }
  }
  return folds;
}

std::vector<double> held_out_fits(std::span<const Recording> recordings, const ChannelChoice& channels,
                                  const ArxOptions& options) {
  constexpr double kShare = 0.3;
  if (channels.inputs.empty()) return {};
  ArxOptions quick = options;
  quick.covariance = quick.judge_free_run = false;
  std::vector<double> error(channels.outputs.size(), 0.0), size = error;
  std::vector<bool> perfect(channels.outputs.size(), true);
  for (const bool last : {true, false}) {
    Fold fold;
    for (const Recording& one : recordings) {
      const auto cut = static_cast<std::size_t>((last ? 1 - kShare : kShare) * static_cast<double>(one.rows()));
      fold.learned.push_back(last ? slice(one, 0, cut) : slice(one, cut, one.rows()));
      fold.held_out.push_back(last ? slice(one, cut, one.rows()) : slice(one, 0, cut));
    }
    const auto fit = fit_arx(fold.learned, channels, quick);
    if (!fit) return {};
    const auto figures = prediction_figures(fit->model, fold.held_out, channels, {.steps = {kFreeRun}});
    if (!figures) return {};
    const PredictionFigures& free = figures->front();
    for (std::size_t i = 0; i < error.size(); ++i) {
      const double square = static_cast<double>(free.rows) * free.mean_square[i], share = 1 - free.fit_percent[i] / 100;
      perfect[i] = perfect[i] && !(square > 0);
      error[i] += square;
      size[i] += share > 0 ? square / (share * share) : 0;
    }
  }
  for (std::size_t i = 0; i < error.size(); ++i)
    error[i] = perfect[i] ? 100 : size[i] > 0 ? 100 * (1 - std::sqrt(error[i] / size[i])) : 0;
  return error;
}

std::vector<Recording> middles_of(std::span<const Recording> recordings, std::size_t max_rows) {
  constexpr std::size_t kRowsOfEach = 400;  // minimum mean rows of a recording: a fifth of it exceeds a kernel's lags
  max_rows = std::max(max_rows, kRowsOfEach * recordings.size());
  std::size_t total = 0;
  for (const Recording& one : recordings) total += one.rows();
  const double share = total > max_rows ? static_cast<double>(max_rows) / static_cast<double>(total) : 1;
  std::vector<Recording> middles;
  for (const Recording& one : recordings) {
    const auto rows = static_cast<std::size_t>(share * static_cast<double>(one.rows()));
    const std::size_t skipped = (one.rows() - rows) / 2;
    middles.push_back(slice(one, skipped, skipped + rows));
  }
  return middles;
}

Result<Eigen::MatrixXd> free_run_parts(const ArxModel& model, std::span<const Recording> recordings,
                                       const ChannelChoice& channels, const FreeRunStart& start) {
  const auto signals = signals_of_model(model, recordings, channels);
  if (!signals) return signals.error();
  const int first_row = std::max(start.first_sample, model.orders.history());
  const auto count = static_cast<std::size_t>(signals->outputs);
  std::vector<Series> outputs(count);
  bool any = false;
  std::size_t before = 0;
  for (std::size_t r = 0; r < recordings.size(); before += recordings[r++].rows()) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto samples = signals->samples[r][i];
      outputs[i].measured.insert(outputs[i].measured.end(), samples.begin(), samples.end());
      outputs[i].error.resize(before + samples.size(), std::numeric_limits<double>::quiet_NaN());
    }
    free_run(model, *signals, r, {start.initial, first_row},
             [&](std::size_t first, std::size_t rows, const double* values) {
               for (std::size_t t = before + first; t < before + first + rows; ++t) {
                 for (std::size_t i = 0; i < count; ++i) {
                   outputs[i].error[t] = outputs[i].measured[t] - (*values++ + model.output_mean[i]);
                   any |= !std::isnan(outputs[i].measured[t]);
                 }
               }
             });
  }
  if (!any) return Error{"no row that was held out can be simulated"};
  Eigen::MatrixXd out(kParts, static_cast<Eigen::Index>(count));
  for (std::size_t i = 0; i < count; ++i) out.col(static_cast<Eigen::Index>(i)) = parts_of(outputs[i]);
  return out;
}

Eigen::VectorXd relative_errors(const Eigen::MatrixXd& errors, const Eigen::MatrixXd& reference) {
  constexpr double kExact = 1e-18;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(errors.rows());
  int outputs = 0;
  for (Eigen::Index i = 0; i < errors.cols(); ++i) {
    const double size = reference.col(i).mean();
    if (!(size > kExact)) continue;
    sum += errors.col(i) / size;
    ++outputs;
  }
  return sum / std::max(outputs, 1);
}

double standard_errors_below(const Eigen::VectorXd& errors, const Eigen::VectorXd& others) {
  const Eigen::ArrayXd gain = (others.array() + 1e-300).log() - (errors.array() + 1e-300).log();
  const double mean = gain.mean(), n = static_cast<double>(gain.size());
  const double error = std::sqrt((gain - mean).square().sum() / (n * (n - 1)));
  return error > 0 ? mean / error : mean > 0 ? std::numeric_limits<double>::infinity() : 0;
}

bool surely_better(const Eigen::VectorXd& errors, const Eigen::VectorXd& others) {
  return standard_errors_below(errors, others) >= 2;
}

}  // namespace wisp::arx
