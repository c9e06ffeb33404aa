#include "learn/outline/outline_alignment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <random>

#include "base/statistics.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/outline/outline_shape.hpp"

namespace wisp {
namespace {

using Series = std::vector<double>;

constexpr std::size_t kWhiteningOrder = 4;  // autoregressive order, which covers a gust's shape at 25 to 60 Hz
constexpr double kFalseAlarm = 0.01;
constexpr int kResamples = 400;          // bootstrap resamples
constexpr double kBlockSeconds = 2;      // longer than a gust, so that blocks are nearly independent
constexpr double kTail = 0.025;          // share of resamples beyond either end of the interval
constexpr double kMaxSharpWidth = 0.05;  // seconds: in an interval up to this width the best offset may lie at an end
constexpr double kAtItsEnd = 0.05;       // share of a wider interval's width: an offset nearer to an end is rejected

Error bad(const std::string& what) { return Error{"alignment: " + what}; }

std::string milliseconds(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f ms", 1000 * seconds);
  return text;
}

/// The series minus its mean; missing samples stay missing.
Series centred(std::span<const double> series) {
  Series out(series.begin(), series.end());
  const double middle = mean(present(out));
  for (double& x : out) x -= middle;
  return out;
}

/// Mean of a(t) b(t + lag) over pairs without missing samples; 0 without such pairs.
double covariance(const Series& a, const Series& b, std::ptrdiff_t lag) {
  double sum = 0;
  double count = 0;
  const std::ptrdiff_t n = static_cast<std::ptrdiff_t>(a.size());
  for (std::ptrdiff_t t = std::max<std::ptrdiff_t>(0, -lag); t < std::min(n, n - lag); ++t) {
    const double product = a[static_cast<std::size_t>(t)] * b[static_cast<std::size_t>(t + lag)];
    if (std::isnan(product)) continue;
    sum += product;
    count += 1;
  }
  return count > 0 ? sum / count : 0;
}

/// Predictor coefficients a1 … ap of the series (Yule–Walker equations, Levinson–Durbin recursion).
std::array<double, kWhiteningOrder> predictor(const Series& series) {
  std::array<double, kWhiteningOrder + 1> r{};
  // With missing samples each lag's mean is over other pairs, which may make the equations indefinite; an addition to
  // lag 0 keeps them solvable.
  for (std::size_t lag = 0; lag < r.size(); ++lag)
    r[lag] = covariance(series, series, static_cast<std::ptrdiff_t>(lag));
  double error = r[0] * (1 + 1e-6);
  std::array<double, kWhiteningOrder> a{};
  for (std::size_t order = 0; order < kWhiteningOrder; ++order) {
    double rest = r[order + 1];
    for (std::size_t i = 0; i < order; ++i) rest -= a[i] * r[order - i];
    const double reflection = rest / error;
    const auto before = a;
    for (std::size_t i = 0; i < order; ++i) a[i] = before[i] - reflection * before[order - 1 - i];
    a[order] = reflection;
    error *= std::max(1 - reflection * reflection, 1e-6);
  }
  return a;
}

Series whitened(const Series& series, const std::array<double, kWhiteningOrder>& a) {
  Series out(series.size(), kMissing);
  for (std::size_t t = kWhiteningOrder; t < series.size(); ++t) {
    out[t] = series[t];
    for (std::size_t i = 0; i < kWhiteningOrder; ++i) out[t] -= a[i] * series[t - 1 - i];
  }
  return out;
}

/// Sums and counts of wind(t) motion(t + lag) per block of time and lag.
struct BlockSums {
  std::size_t lags = 0;
  std::size_t blocks = 0;
  Series sums;    ///< blocks × lags
  Series counts;  ///< blocks × lags

  BlockSums(const Series& wind, const Series& motion, std::ptrdiff_t most, std::size_t block)
      : lags(static_cast<std::size_t>(2 * most + 1)),
        blocks((wind.size() + block - 1) / block),
        sums(blocks * lags, 0.0),
        counts(blocks * lags, 0.0) {
    const std::ptrdiff_t n = static_cast<std::ptrdiff_t>(wind.size());
    for (std::ptrdiff_t t = 0; t < n; ++t) {
      const std::size_t row = static_cast<std::size_t>(t) / block * lags;
      for (std::ptrdiff_t lag = std::max(-most, -t); lag <= std::min(most, n - 1 - t); ++lag) {
        const double product = wind[static_cast<std::size_t>(t)] * motion[static_cast<std::size_t>(t + lag)];
        if (std::isnan(product)) continue;
        sums[row + static_cast<std::size_t>(lag + most)] += product;
        counts[row + static_cast<std::size_t>(lag + most)] += 1;
      }
    }
  }

  /// Means over blocks, each block counted as often as `weights` says.
  Series means(const Series& weights) const {
    Series sum(lags, 0.0);
    Series count(lags, 0.0);
    for (std::size_t b = 0; b < blocks; ++b) {
      if (weights[b] == 0) continue;
      for (std::size_t k = 0; k < lags; ++k) {
        sum[k] += weights[b] * sums[b * lags + k];
        count[k] += weights[b] * counts[b * lags + k];
      }
    }
    for (std::size_t k = 0; k < lags; ++k) sum[k] = count[k] > 0 ? sum[k] / count[k] : 0;
    return sum;
  }
};

/// Index of the largest |value|, refined by a parabola through it and its neighbours.
double peak_of(const Series& values) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (std::abs(values[k]) > std::abs(values[best])) best = k;
  }
  if (best == 0 || best + 1 == values.size()) return static_cast<double>(best);
  const double sign = values[best] < 0 ? -1 : 1;
  const double before = sign * values[best - 1];
  const double after = sign * values[best + 1];
  const double bend = before - 2 * sign * values[best] + after;
  const double shift = bend < 0 ? 0.5 * (before - after) / bend : 0;
  return static_cast<double>(best) + std::clamp(shift, -0.5, 0.5);
}

/// Level of |correlation| that the largest of `lags` correlations of unrelated series exceeds with probability
/// kFalseAlarm: Bartlett's variance with both autocorrelations, Bonferroni over the lags.
double chance_level(const Series& wind, const Series& motion, std::size_t lags, double pairs) {
  const double wind_power = covariance(wind, wind, 0);
  const double motion_power = covariance(motion, motion, 0);
  double sum = 1;
  for (std::ptrdiff_t lag = 1; lag < static_cast<std::ptrdiff_t>(lags / 2); ++lag) {
    sum += 2 * covariance(wind, wind, lag) / wind_power * covariance(motion, motion, lag) / motion_power;
  }
  // P(|z| > x) ≤ exp(−x²/2) for a normal z, so the level is conservative.
  const double z = std::sqrt(2 * std::log(static_cast<double>(lags) / kFalseAlarm));
  return z * std::sqrt(std::max(sum, 1.0) / pairs);
}

/// Returns the ends of the bootstrap's 95 % interval of the peak's index.
std::array<double, 2> bootstrap(const BlockSums& sums) {
  std::mt19937_64 random(1);
  Series peaks;
  for (int i = 0; i < kResamples; ++i) {
    Series weights(sums.blocks, 0.0);
    for (std::size_t b = 0; b < sums.blocks; ++b) weights[random() % sums.blocks] += 1;
    peaks.push_back(peak_of(sums.means(weights)));
  }
  return {quantile(peaks, kTail), quantile(peaks, 1 - kTail)};
}

void judge(Alignment& found, double max_seconds) {
  const double width = found.high_seconds - found.low_seconds;
  const double to_end = std::min(found.offset_seconds - found.low_seconds, found.high_seconds - found.offset_seconds);
  if (std::abs(found.correlation) < found.chance) {
    found.reason = "motion and wind have nothing in common that stands out from chance";
  } else if (found.low_seconds <= -max_seconds || found.high_seconds >= max_seconds) {
    found.reason = "the best offset lies at the search's end; search farther";
  } else if (width > kMaxSharpWidth && to_end < kAtItsEnd * width) {
    found.reason = "the best offset, " + milliseconds(found.offset_seconds) + ", lies at the end of its own interval";
  } else if (width > max_seconds) {
    found.reason = "the offset is only known to " + milliseconds(width);
  } else {
    found.usable = true;
    const bool before = found.offset_seconds < 0;
    const double from = before ? -found.high_seconds : found.low_seconds;
    const double to = before ? -found.low_seconds : found.high_seconds;
    found.reason = "the motion comes " + milliseconds(std::abs(found.offset_seconds)) +
                   (before ? " before" : " after") + " the sound (" + milliseconds(from) + " to " + milliseconds(to) +
                   ")";
  }
}

constexpr double kMinSearch = 0.05;  // minimum range searched on either side, seconds

// Returns the offset, searched within ± a fifth of the known rows, at most 1 s; an error becomes the reason.
Alignment found_or_reason(const Recording& recording, const std::vector<double>& input,
                          const std::vector<double>& motion) {
  double rows = 0;
  for (std::size_t t = 0; t < input.size(); ++t) rows += std::isnan(input[t] + motion[t]) ? 0 : 1;
  AlignmentOptions options{.rate_hz = recording.rate_hz};
  options.max_seconds = std::clamp(rows / recording.rate_hz / 5, kMinSearch, options.max_seconds);
  auto found = align_offset(input, motion, options);
  return found ? *std::move(found) : Alignment{.reason = found.error().message};
}

double clarity(const Alignment& alignment) {
  return alignment.chance > 0 ? std::abs(alignment.correlation) / alignment.chance : 0;
}

// Frames by which the input lags the motion; 0 unless the lag is significant.
int frames_too_late(const Alignment& alignment, double rate_hz) {
  if (!alignment.usable || alignment.high_seconds >= 0) return 0;
  return static_cast<int>(std::lround(-alignment.offset_seconds * rate_hz));
}

void move_earlier(Recording& recording, std::size_t channel, int frames) {
  auto& samples = recording.channels[channel].samples;
  for (const Episode& episode : episodes(recording)) {
    const auto begin = samples.begin() + static_cast<std::ptrdiff_t>(episode.begin);
    const auto end = samples.begin() + static_cast<std::ptrdiff_t>(episode.end);
    const auto kept = std::min(static_cast<std::ptrdiff_t>(frames), end - begin);
    std::copy(begin + kept, end, begin);
    std::fill(end - kept, end, kMissing);
  }
}

// Position of the tip relative to the middle of the base, per row; NaN where missing.
struct TipMotion {
  Series sway, height;
};

TipMotion tip_motion(const Recording& recording, const OutlineLayout& layout) {
  const OutlineCurve curve(layout.knots);
  TipMotion out;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const std::vector<double> control = whole_row(recording, layout, row);
    const OutlinePoint tip = control.empty() ? OutlinePoint{kMissing, kMissing} : tip_of(curve.polyline(control));
    const std::size_t last = control.empty() ? 0 : control.size() - 2;
    out.sway.push_back(control.empty() ? kMissing : tip[0] - (control[0] + control[last]) / 2);
    out.height.push_back(control.empty() ? kMissing : tip[1] - (control[1] + control[last + 1]) / 2);
  }
  return out;
}

}  // namespace

Result<Alignment> align_offset(std::span<const double> wind, std::span<const double> motion,
                               const AlignmentOptions& options) {
  if (wind.size() != motion.size()) {
    return bad("the wind has " + std::to_string(wind.size()) + " samples, the motion " + std::to_string(motion.size()) +
               ", expected as many");
  }
  double pairs = 0;
  for (std::size_t t = 0; t < wind.size(); ++t) pairs += std::isfinite(wind[t]) && std::isfinite(motion[t]) ? 1 : 0;
  const double least = std::max(4 * options.max_seconds * options.rate_hz, 4.0 * kWhiteningOrder);
  if (pairs < least) {
    return bad(std::to_string(static_cast<long long>(pairs)) + " samples in which both are known, expected at least " +
               std::to_string(static_cast<long long>(std::ceil(least))) + " (four times the search)");
  }
  const Series centred_wind = centred(wind);
  const Series centred_motion = centred(motion);
  if (!(covariance(centred_wind, centred_wind, 0) > 0)) return bad("the wind never changes");
  if (!(covariance(centred_motion, centred_motion, 0) > 0)) return bad("the motion never changes");

  const auto filter = predictor(centred_wind);
  const Series white_wind = whitened(centred_wind, filter);
  const Series white_motion = whitened(centred_motion, filter);
  const auto most = static_cast<std::ptrdiff_t>(std::lround(options.max_seconds * options.rate_hz));
  const auto block = static_cast<std::size_t>(std::max(std::lround(kBlockSeconds * options.rate_hz), 1L));
  const BlockSums sums(white_wind, white_motion, most, block);
  const Series all = sums.means(Series(sums.blocks, 1.0));

  const double scale = std::sqrt(covariance(white_wind, white_wind, 0) * covariance(white_motion, white_motion, 0));
  const double peak = peak_of(all);
  const auto seconds = [&](double place) { return (place - static_cast<double>(most)) / options.rate_hz; };
  const auto [low, high] = bootstrap(sums);
  Alignment found;
  found.offset_seconds = seconds(peak);
  found.low_seconds = seconds(std::min(low, peak));
  found.high_seconds = seconds(std::max(high, peak));
  found.correlation = scale > 0 ? all[static_cast<std::size_t>(std::lround(peak))] / scale : 0;
  found.chance = chance_level(white_wind, white_motion, all.size(), pairs);
  judge(found, options.max_seconds);
  return found;
}

std::string InputAlignment::note() const {
  if (frames_moved == 0) return input + ": " + found.reason;
  return input + ": " + found.reason + "; it was moved " + std::to_string(frames_moved) +
         " frames earlier, since nothing moves before it is blown at";
}

Result<AlignedOutline> align_outline(const Recording& recording, const std::vector<std::string>& inputs) {
  const auto layout = outline_layout(recording);
  if (!layout) return layout.error();
  AlignedOutline out{recording, {}};
  const TipMotion tip = tip_motion(recording, *layout);
  for (const std::string& name : inputs) {
    const auto channel = find_channel(recording, name);
    if (!channel) continue;
    const auto& samples = recording.channels[*channel].samples;
    const Alignment sway = found_or_reason(recording, samples, tip.sway);
    const Alignment height = found_or_reason(recording, samples, tip.height);
    const bool by_sway = clarity(sway) >= clarity(height);
    InputAlignment one{recording.source, name, by_sway ? "sway" : "height", by_sway ? sway : height, 0};
    one.frames_moved = frames_too_late(one.found, recording.rate_hz);
    if (one.frames_moved > 0) move_earlier(out.recording, *channel, one.frames_moved);
    out.inputs.push_back(std::move(one));
  }
  return out;
}

}  // namespace wisp
