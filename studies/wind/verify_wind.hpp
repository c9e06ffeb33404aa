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

#include "studies/verify_bounds.hpp"

namespace wisp::verify {

/// Where the recordings are: WISP_DATA, or ../shared/data beside the project.
inline std::filesystem::path data_folder() {
  if (const char* set = std::getenv("WISP_DATA")) return set;
  return std::filesystem::path(WISP_SOURCE_DIR) / ".." / "shared" / "data";
}

/// Half of a Blackman-windowed sinc with 24 zero crossings each side, tabulated finely.
class SincTable {
 public:
  explicit SincTable(double cutoff) : cutoff_(cutoff), reach_(12 / cutoff), values_(kSteps * 12 + 2) {
    for (std::size_t i = 0; i + 1 < values_.size(); ++i) {
      const double turns = static_cast<double>(i) / kSteps;  // of the cutoff frequency
      const double turn = std::numbers::pi * turns / 12;
      const double window = 0.42 + 0.5 * std::cos(turn) + 0.08 * std::cos(2 * turn);
      const double angle = 2 * std::numbers::pi * turns;
      values_[i] = window * 2 * cutoff * (i == 0 ? 1 : std::sin(angle) / angle);
    }
  }

  double reach() const { return reach_; }

  double at(double samples) const {
    const double place = std::abs(samples) * cutoff_ * kSteps;
    const auto i = std::min(static_cast<std::size_t>(place), values_.size() - 2);
    const double part = place - static_cast<double>(i);
    return values_[i] + part * (values_[i + 1] - values_[i]);
  }

 private:
  static constexpr std::size_t kSteps = 2048;
  double cutoff_;
  double reach_;
  std::vector<double> values_;
};

/// The sound at another rate, cut off at 45 % of the lower one.
inline std::vector<float> resampled(std::span<const float> sound, double from_hz, double to_hz) {
  if (from_hz == to_hz) return {sound.begin(), sound.end()};
  const SincTable sinc(0.45 * std::min(from_hz, to_hz) / from_hz);
  std::vector<float> out(static_cast<std::size_t>(static_cast<double>(sound.size()) * to_hz / from_hz));
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double at = static_cast<double>(i) * from_hz / to_hz;
    const auto first = static_cast<std::ptrdiff_t>(std::ceil(std::max(0.0, at - sinc.reach())));
    const auto last =
        std::min(static_cast<std::ptrdiff_t>(sound.size()) - 1, static_cast<std::ptrdiff_t>(at + sinc.reach()));
    double sum = 0;
    for (std::ptrdiff_t k = first; k <= last; ++k) {
      sum += sinc.at(static_cast<double>(k) - at) * static_cast<double>(sound[static_cast<std::size_t>(k)]);
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
void blowing(Bounds& bounds);

/// What likeness is fitted on, as CSV.
void print_features();

}  // namespace wisp::verify
