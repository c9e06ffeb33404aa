#pragma once
// How restless a light is, half a second at a time, and what that makes of its rows.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace wisp::flicker {

/// Below this standard deviation within half a second, of a mean of 1, a light looks still: a few times what an eye
/// can tell of it.
inline constexpr double kCalm = 0.02;

/// Rows of half a second.
std::size_t half_second(double rate_hz);

/// Standard deviation around each row, over `window` rows.
///
/// Precondition: trace.size() >= window, window >= 2.
std::vector<double> restlessness(std::span<const double> trace, std::size_t window);

/// What is looked at of a light.
struct Figures {
  double mean = 0;
  double sd = 0;
  double calm_share = 0;  ///< of half seconds one after the other that are calmer than kCalm
};

/// Precondition: some trace has half a second.
Figures figures_of(std::span<const std::vector<double>> traces, double rate_hz);

/// Rows by how restless they are: k-means of the logarithm in one dimension, calmest first. Returns centroids.
///
/// Precondition: there are at least `modes` rows, and modes > 0.
std::vector<double> levels_of(std::span<const std::vector<double>> restless, int modes, std::uint64_t seed);

/// The nearest level of each row.
std::vector<int> nearest_levels(std::span<const double> restless, std::span<const double> levels);

}  // namespace wisp::flicker
