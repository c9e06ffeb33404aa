#pragma once
// What the parts of the wind's long check share: bounds, data, sounds at another rate.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "verify_bounds.hpp"

namespace wisp::verify {

/// Where the recordings are: WISP_DATA, or ../shared/data beside the project.
inline std::filesystem::path data_folder() {
  if (const char* set = std::getenv("WISP_DATA")) return set;
  return std::filesystem::path(WISP_SOURCE_DIR) / ".." / "shared" / "data";
}

/// The sound at another rate: a Blackman-windowed sinc over 24 zero crossings each side, cut off at 45 % of the lower
/// rate.
inline std::vector<float> resampled(std::span<const float> sound, double from_hz, double to_hz) {
  if (from_hz == to_hz) return {sound.begin(), sound.end()};
  const double cutoff = 0.45 * std::min(from_hz, to_hz) / from_hz;
  const double reach = 12 / cutoff;
  std::vector<float> out(static_cast<std::size_t>(static_cast<double>(sound.size()) * to_hz / from_hz));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double at = static_cast<double>(i) * from_hz / to_hz;
    const auto first = static_cast<std::ptrdiff_t>(std::ceil(std::max(0.0, at - reach)));
    const auto last = std::min(static_cast<std::ptrdiff_t>(sound.size()) - 1, static_cast<std::ptrdiff_t>(at + reach));
    double sum = 0;
    for (std::ptrdiff_t k = first; k <= last; ++k) {
      const double x = static_cast<double>(k) - at;
      const double turn = std::numbers::pi * x / reach;
      const double window = 0.42 + 0.5 * std::cos(turn) + 0.08 * std::cos(2 * turn);
      const double sinc = x == 0 ? 2 * cutoff : std::sin(2 * std::numbers::pi * cutoff * x) / (std::numbers::pi * x);
      sum += window * sinc * static_cast<double>(sound[static_cast<std::size_t>(k)]);
    }
    out[i] = static_cast<float>(sum);
  }
  return out;
}

inline double mean(std::span<const double> values) {
  return values.empty() ? 0 : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The parts of the check; each prints its tables and bounds, or says why it was skipped.
void anemometer(Bounds& bounds);
void gusts(Bounds& bounds);
void confidence(Bounds& bounds);

}  // namespace wisp::verify
