#include "learn/flame/blow_outs.hpp"

#include <algorithm>
#include <cmath>

#include "base/statistics.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/outline/outline_units.hpp"

namespace wisp {
namespace {

constexpr double kUsual = 0.95;        // quantile of the wind on a burning flame: a blow-out has stronger wind
constexpr double kMinGone = 0.5;       // minimum seconds of an absence: spontaneous disappearances are shorter
constexpr double kLookedBack = 0.6;    // seconds before the disappearance that are searched for the wind
constexpr double kMinBlown = 0.15;     // seconds over which wind is averaged: noise has short peaks, wind lasts
constexpr double kSettling = 0.5;      // seconds after re-ignition that are excluded as transient
constexpr double kMinPresence = 0.15;  // seconds: appearances shorter than it and the absence before are an ember's

constexpr double kUsualStep = 0.9, kJump = 20, kJumpHeights = 0.2, kMaxRemoved = 0.05;  // see remove_jumps()

// Runs of rows without an outline, joined over an ember's appearances. Rows of lost pictures (kLostRows) do not count.
std::vector<Episode> absences(const Recording& recording, const OutlineLayout& layout) {
  std::vector<Episode> runs;
  const std::size_t least = rows_of(kMinPresence, recording.rate_hz);
  std::size_t appeared = 0;  // rows with an outline since the last run
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    if (is_flagged(recording, kLostRows, row)) continue;
    const bool seen = std::none_of(layout.outputs.begin(), layout.outputs.end(),
                                   [&](std::size_t c) { return std::isnan(recording.channels[c].samples[row]); });
    appeared += seen ? 1 : 0;
    if (seen) continue;
    if (!runs.empty() && row < runs.back().end + least && appeared < runs.back().size()) {
      runs.back().end = row + 1;
    } else {
      runs.push_back({row, row + 1});
    }
    appeared = 0;
  }
  return runs;
}

// Strength of an input, averaged over the last `window` rows; missing samples count as calm.
std::vector<double> averaged(const std::vector<double>& samples, std::size_t window) {
  std::vector<double> out;
  double sum = 0;
  const auto strength = [&](std::size_t row) { return std::isnan(samples[row]) ? 0.0 : std::abs(samples[row]); };
  for (std::size_t row = 0; row < samples.size(); ++row) {
    sum += strength(row);
    if (row >= window) sum -= strength(row - window);
    out.push_back(std::max(0.0, sum) / static_cast<double>(window));
  }
  return out;
}

// kUsual quantile of the wind in rows where the flame is visible and not about to go out.
double usual_wind(const std::vector<double>& wind, const std::vector<Episode>& gone, std::size_t looked_back) {
  std::vector<double> lived;
  std::size_t next = 0;
  for (std::size_t row = 0; row < wind.size(); ++row) {
    while (next < gone.size() && row >= gone[next].end) ++next;
    if (next == gone.size() || row + looked_back < gone[next].begin) lived.push_back(wind[row]);
  }
  return quantile(lived, kUsual);
}

// Row at which the extinguishing wind began: the last one, within kLookedBack, at which an input rose through half of
// the peak; of several inputs the earliest.
std::size_t onset(const Recording& recording, const BlowOut& blow_out) {
  const std::size_t back = std::min(blow_out.gone, rows_of(kLookedBack, recording.rate_hz));
  std::size_t first = blow_out.gone;
  for (std::size_t channel : channels_with_role(recording, Role::kInput)) {
    const auto& samples = recording.channels[channel].samples;
    std::size_t row = blow_out.gone;
    while (row > blow_out.gone - back && !(std::abs(samples[row - 1]) > 0.5 * blow_out.wind)) --row;
    while (row > blow_out.gone - back && !(std::abs(samples[row - 1]) < 0.5 * blow_out.wind)) --row;
    first = std::min(first, row);
  }
  return first;
}

// RMS motion of the control points since the row before; `height` receives the median height of outlines.
std::vector<double> steps_of(const Recording& recording, const OutlineLayout& layout, double& height) {
  std::vector<double> steps(recording.rows(), kMissing), heights;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const auto at = [&](std::size_t c, std::size_t r) { return recording.channels[layout.outputs[c]].samples[r]; };
    double square = 0, low = at(1, row), high = low;
    for (std::size_t c = 0; c < layout.outputs.size(); ++c) {
      square += row > 0 ? std::pow(at(c, row) - at(c, row - 1), 2) : kMissing;
      if (c % 2 == 1) low = std::min(low, at(c, row)), high = std::max(high, at(c, row));
    }
    steps[row] = std::sqrt(square / static_cast<double>(layout.points));
    if (!std::isnan(high)) heights.push_back(high - low);
  }
  height = median(std::move(heights));
  return steps;
}

}  // namespace

std::size_t remove_jumps(Recording& recording) {
  const auto layout = outline_layout(recording);
  if (!layout) return 0;
  double height = 0;
  const auto steps = steps_of(recording, *layout, height);
  const std::vector<double> known = present(steps);
  if (known.empty()) return 0;
  const double longest = std::max(kJump * quantile(known, kUsualStep), kJumpHeights * height);
  std::vector<std::size_t> jumps{0};
  for (std::size_t row = 1; row < steps.size(); ++row) {
    if (steps[row] > longest) jumps.push_back(row);
  }
  jumps.push_back(steps.size());
  std::vector<std::size_t> removed;
  for (std::size_t k = 0; k + 1 < jumps.size() && jumps.size() > 2; ++k) {
    if (jumps[k + 1] - jumps[k] >= rows_of(kMinGone, recording.rate_hz)) continue;
    for (std::size_t row = jumps[k]; row < jumps[k + 1]; ++row) removed.push_back(row);
  }
  if (kMaxRemoved * static_cast<double>(steps.size()) < static_cast<double>(removed.size())) return 0;
  for (const std::size_t c : layout->outputs) {
    for (const std::size_t row : removed) recording.channels[c].samples[row] = kMissing;
  }
  return removed.size();
}

std::size_t rows_of(double seconds, double rate_hz) {
  return static_cast<std::size_t>(std::max(1L, std::lround(seconds * rate_hz)));
}

Result<std::vector<BlowOut>> find_blow_outs(const Recording& recording, const std::string& input) {
  const auto layout = outline_layout(recording);
  if (!layout) return layout.error();
  const auto channel = find_channel(recording, input);
  if (!channel) {
    return Error{recording.source + ": has no input " + input +
                 ", which tells what blew the flame out; expected the flame filmed with its sound, and the measure of "
                 "wind that the model takes"};
  }
  std::vector<Episode> gone = absences(recording, *layout);
  const std::size_t least = rows_of(kMinGone, recording.rate_hz);
  std::erase_if(gone, [&](const Episode& run) { return run.size() < least; });
  const std::size_t looked_back = rows_of(kLookedBack, recording.rate_hz);
  const std::size_t window = rows_of(kMinBlown, recording.rate_hz);
  const auto wind = averaged(recording.channels[*channel].samples, window);
  const double usual = usual_wind(wind, gone, looked_back);
  const std::vector<Episode> starts = episodes(recording);
  std::vector<BlowOut> out;
  for (const Episode& run : gone) {
    if (run.begin == 0) continue;
    const auto begins = [&](const Episode& one) { return one.begin == run.begin; };
    const bool seen = std::none_of(starts.begin(), starts.end(), begins);
    // A strong puff lasts beyond the few frames in which the flame disappears, so rows of the absence count too.
    const std::size_t first = run.begin - std::min(run.begin, looked_back);
    const std::size_t last = std::min(run.end, run.begin + window);
    const double strongest = *std::max_element(wind.begin() + static_cast<std::ptrdiff_t>(first),
                                               wind.begin() + static_cast<std::ptrdiff_t>(last));
    out.push_back({run.begin, run.end, strongest, seen && strongest > usual});
  }
  return out;
}

Recording without_blow_outs(const Recording& recording, std::span<const BlowOut> blow_outs) {
  Recording out = recording;
  const auto settling = static_cast<std::size_t>(std::lround(kSettling * recording.rate_hz));
  for (const BlowOut& blow_out : blow_outs) {
    if (!blow_out.blown) continue;
    const std::size_t first = onset(recording, blow_out);
    const std::size_t last = std::min(out.rows(), blow_out.back + settling);
    for (Channel& channel : out.channels) {
      std::fill(channel.samples.begin() + static_cast<std::ptrdiff_t>(first),
                channel.samples.begin() + static_cast<std::ptrdiff_t>(last), kMissing);
    }
  }
  return out;
}

}  // namespace wisp
