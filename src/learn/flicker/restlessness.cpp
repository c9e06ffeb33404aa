#include "learn/flicker/restlessness.hpp"

#include <algorithm>
#include <cmath>

#include "learn/numeric/clustering.hpp"

namespace wisp::flicker {
namespace {

// Below this a photodiode's own noise is all there is.
double level(double restless) { return std::log(restless + 1e-5); }

std::size_t nearest(double value, std::span<const double> levels) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < levels.size(); ++k) {
    if (std::abs(value - levels[k]) < std::abs(value - levels[best])) best = k;
  }
  return best;
}

}  // namespace

std::size_t half_second(double rate_hz) { return static_cast<std::size_t>(std::max(4.0, std::round(rate_hz / 2))); }

std::vector<double> restlessness(std::span<const double> trace, std::size_t window) {
  // Sums about a value of the trace lose nothing to cancellation.
  const double origin = trace.front();
  std::vector<double> sum{0}, square{0};
  for (const double value : trace) {
    sum.push_back(sum.back() + value - origin);
    square.push_back(square.back() + (value - origin) * (value - origin));
  }
  std::vector<double> out;
  const auto n = static_cast<double>(window);
  for (std::size_t row = 0; row < trace.size(); ++row) {
    const std::size_t begin = std::min(row - std::min(row, window / 2), trace.size() - window);
    const double mean = (sum[begin + window] - sum[begin]) / n;
    out.push_back(std::sqrt(std::max(0.0, (square[begin + window] - square[begin]) / n - mean * mean)));
  }
  return out;
}

Figures figures_of(std::span<const std::vector<double>> traces, double rate_hz) {
  Figures figures;
  const std::size_t window = half_second(rate_hz);
  double sum = 0, square = 0, rows = 0, calm = 0, windows = 0;
  for (const auto& trace : traces) {
    for (const double value : trace) sum += value;
    rows += static_cast<double>(trace.size());
  }
  figures.mean = sum / rows;
  for (const auto& trace : traces) {
    for (const double value : trace) square += (value - figures.mean) * (value - figures.mean);
    if (trace.size() < window) continue;
    const auto restless = restlessness(trace, window);
    for (std::size_t middle = window / 2; middle + window - window / 2 <= trace.size(); middle += window) {
      calm += restless[middle] < kCalm * figures.mean;
      windows += 1;
    }
  }
  figures.sd = std::sqrt(square / rows);
  figures.calm_share = calm / windows;
  return figures;
}

std::vector<double> levels_of(std::span<const std::vector<double>> restless, int modes, std::uint64_t seed) {
  std::vector<double> values;
  for (const auto& trace : restless) {
    for (const double value : trace) values.push_back(level(value));
  }
  auto levels = k_means(values, 1, {.clusters = modes, .seed = seed})->centroids;
  std::sort(levels.begin(), levels.end());
  return levels;
}

std::vector<int> nearest_levels(std::span<const double> restless, std::span<const double> levels) {
  std::vector<int> out;
  for (const double value : restless) out.push_back(static_cast<int>(nearest(level(value), levels)));
  return out;
}

}  // namespace wisp::flicker
