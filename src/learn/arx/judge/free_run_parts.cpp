#include "learn/arx/judge/free_run_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "learn/arx/judge/prediction.hpp"

namespace wisp::arx {
namespace {

constexpr double kMaxError = 1e6;  // standard deviations: what diverges is as bad as can be, and can be added

// One output over all recordings, NaN where it is not measured or not simulated.
struct Series {
  std::vector<double> measured;
  std::vector<double> error;
};

// Its standard deviation; 0 where all that moves is rounding. No unit is too small to be squared.
double deviation_of(const std::vector<double>& measured) {
  double sum = 0, rows = 0, most = 0, square = 0;
  for (double y : measured) {
    if (!std::isnan(y)) sum += y, ++rows;
  }
  const double mean = sum / std::max(rows, 1.0);
  for (double y : measured) {
    if (!std::isnan(y)) most = std::max(most, std::abs(y - mean));
  }
  constexpr double kStill = 1e-9;  // of its size
  if (!(most > kStill * std::abs(mean))) return 0;
  for (double y : measured) {
    if (!std::isnan(y)) square += (y - mean) / most * ((y - mean) / most);
  }
  return most * std::sqrt(square / rows);
}

// Mean squared error of one output in every part.
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

Result<Eigen::MatrixXd> free_run_parts(const ArxModel& model, std::span<const Recording> recordings,
                                       const ChannelChoice& channels) {
  std::vector<Series> outputs(channels.outputs.size());
  bool any = false;
  for (const Recording& recording : recordings) {
    const auto simulated = predict(model, recording, channels, {.steps = kFreeRun});
    if (!simulated) return simulated.error();
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      const auto& measured = recording.channels[*find_channel(recording, channels.outputs[i])].samples;
      for (std::size_t t = 0; t < measured.size(); ++t) {
        outputs[i].measured.push_back(measured[t]);
        outputs[i].error.push_back(measured[t] - (*simulated)[i][t]);
        any |= !std::isnan(outputs[i].error.back());
      }
    }
  }
  if (!any) return Error{"no row that was held out can be simulated"};
  Eigen::MatrixXd out(kParts, static_cast<Eigen::Index>(outputs.size()));
  for (std::size_t i = 0; i < outputs.size(); ++i) out.col(static_cast<Eigen::Index>(i)) = parts_of(outputs[i]);
  return out;
}

Eigen::VectorXd relative_errors(const Eigen::MatrixXd& errors, const Eigen::MatrixXd& others) {
  constexpr double kExact = 1e-18;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(errors.rows());
  int outputs = 0;
  for (Eigen::Index i = 0; i < errors.cols(); ++i) {
    const double size = others.col(i).mean();
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

}  // namespace wisp::arx
