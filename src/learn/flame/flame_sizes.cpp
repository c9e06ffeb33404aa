#include "learn/flame/flame_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/outline/outline_units.hpp"

namespace wisp {
namespace {

constexpr double kDecaySeen = 0.6;     // seconds before it is gone; earlier changes belong to the gust
constexpr double kReIgnitionSeen = 2;  // seconds after it is seen again
constexpr double kGridStep = 1.02;     // of durations: finer than a row tells

double size_of(const Recording& recording, const OutlineLayout& layout, std::size_t row) {
  const auto at = [&](std::size_t k) { return recording.channels[layout.outputs[k]].samples[row]; };
  const std::size_t points = layout.points;
  double twice = 0;
  for (std::size_t p = 0; p < points; ++p) {
    const std::size_t q = (p + 1) % points;
    twice += at(2 * p) * at(2 * q + 1) - at(2 * q) * at(2 * p + 1);
  }
  return std::sqrt(std::abs(twice) / 2);
}

// A ramp to be fitted. In a bank a flame dies in whole steps from full size; a recorded one begins half a row after the
// first on average, and the size in a bank's last step jumps where a duration passes a row.
double fitted_size(SizeChange change, double seconds, double rate_hz, std::size_t row) {
  if (change == SizeChange::kReIgnition) return ramp_size(change, seconds, rate_hz, row);
  return std::min(1.0, (static_cast<double>(row) + 0.5) / (seconds * rate_hz));
}

using Ramp = double (*)(SizeChange change, double seconds, double rate_hz, std::size_t row);

double squared_error(Ramp ramp, SizeChange change, double seconds, const SizeCurve& curve, std::size_t& rows) {
  double sum = 0;
  for (std::size_t row = 0; row < curve.size.size(); ++row) {
    if (std::isnan(curve.size[row])) continue;
    const double off = curve.size[row] - ramp(change, seconds, curve.rate_hz, row);
    sum += off * off;
    ++rows;
  }
  return sum;
}

double longest_seconds(std::span<const SizeCurve> curves) {
  double longest = 0;
  for (const SizeCurve& curve : curves) {
    longest = std::max(longest, static_cast<double>(curve.size.size()) / curve.rate_hz);
  }
  return longest;
}

// Squared errors [duration][curve], from which the best of all curves and of all but one are found alike.
class Trials {
 public:
  Trials(SizeChange change, std::span<const SizeCurve> curves) {
    const double shortest = 1 / curves.front().rate_hz, longest = longest_seconds(curves);
    for (double seconds = shortest; seconds <= longest; seconds *= kGridStep) {
      seconds_.push_back(seconds);
      std::vector<double>& errors = errors_.emplace_back();
      for (const SizeCurve& curve : curves) {
        std::size_t rows = 0;
        errors.push_back(squared_error(fitted_size, change, seconds, curve, rows));
      }
    }
  }

  /// The duration of least error over all curves but `left_out`.
  double best(std::size_t left_out) const {
    double least = std::numeric_limits<double>::infinity(), best = 0;
    for (std::size_t k = 0; k < seconds_.size(); ++k) {
      double sum = 0;
      for (std::size_t c = 0; c < errors_[k].size(); ++c) sum += c == left_out ? 0 : errors_[k][c];
      if (sum >= least) continue;
      least = sum;
      best = seconds_[k];
    }
    return best;
  }

 private:
  std::vector<double> seconds_;
  std::vector<std::vector<double>> errors_;
};

// The jackknife's standard error.
double std_error(const Trials& trials, std::size_t curves) {
  if (curves < 2) return 0;
  std::vector<double> without;
  double mean = 0;
  for (std::size_t c = 0; c < curves; ++c) {
    without.push_back(trials.best(c));
    mean += without.back() / static_cast<double>(curves);
  }
  double square = 0;
  for (double one : without) square += (one - mean) * (one - mean);
  return std::sqrt(square * static_cast<double>(curves - 1) / static_cast<double>(curves));
}

}  // namespace

Result<std::vector<double>> flame_sizes(const Recording& recording, std::span<const BlowOut> blow_outs) {
  const auto layout = outline_layout(recording);
  if (!layout) return layout.error();
  const Recording undisturbed = without_blow_outs(recording, blow_outs);
  std::vector<double> sizes, burning;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    sizes.push_back(size_of(recording, *layout, row));
    const double size = size_of(undisturbed, *layout, row);
    if (!std::isnan(size)) burning.push_back(size);
  }
  const double usual = burning.empty() ? kMissing : median(std::move(burning));
  for (double& size : sizes) size /= usual;
  return sizes;
}

std::vector<SizeCurve> size_curves(const Recording& recording, std::span<const double> sizes,
                                   std::span<const BlowOut> blow_outs, SizeChange change) {
  std::vector<SizeCurve> curves;
  const bool decay = change == SizeChange::kDecay;
  const auto most = static_cast<std::size_t>(std::lround((decay ? kDecaySeen : kReIgnitionSeen) * recording.rate_hz));
  for (std::size_t k = 0; k < blow_outs.size(); ++k) {
    const BlowOut& blow_out = blow_outs[k];
    if (!blow_out.blown) continue;
    const std::size_t lit = k > 0 ? blow_outs[k - 1].back : 0;
    const std::size_t next = k + 1 < blow_outs.size() ? blow_outs[k + 1].gone : recording.rows();
    const std::size_t rows = std::min(most, decay ? blow_out.gone - lit : next - blow_out.back);
    SizeCurve curve{recording.rate_hz, {}};
    for (std::size_t row = 0; row < rows; ++row) {
      curve.size.push_back(sizes[decay ? blow_out.gone - 1 - row : blow_out.back + row]);
    }
    const bool seen = std::any_of(curve.size.begin(), curve.size.end(), [](double size) { return !std::isnan(size); });
    if (seen) curves.push_back(std::move(curve));
  }
  return curves;
}

double ramp_size(SizeChange change, double seconds, double rate_hz, std::size_t row) {
  const double steps = std::max(1.0, seconds * rate_hz);
  constexpr double kRounding = 1e-9;
  const double last = change == SizeChange::kDecay ? 1 + steps - std::ceil(steps - kRounding) : 1;  // of a step
  return std::min(1.0, (static_cast<double>(row) + last) / steps);
}

double ramp_error(SizeChange change, double seconds, std::span<const SizeCurve> curves) {
  double sum = 0;
  std::size_t rows = 0;
  for (const SizeCurve& curve : curves) sum += squared_error(ramp_size, change, seconds, curve, rows);
  return rows > 0 ? std::sqrt(sum / static_cast<double>(rows)) : 0;
}

std::optional<RampFit> learn_ramp(SizeChange change, std::span<const SizeCurve> curves) {
  if (curves.empty()) return std::nullopt;
  const Trials trials(change, curves);
  RampFit fit;
  fit.seconds = trials.best(curves.size());
  fit.events = curves.size();
  fit.error = ramp_error(change, fit.seconds, curves);
  const double off = kNormal95 * std_error(trials, curves.size()) + 0.5 / curves.front().rate_hz;
  fit.seconds_ci95 = {std::max(0.0, fit.seconds - off), fit.seconds + off};
  return fit;
}

}  // namespace wisp
