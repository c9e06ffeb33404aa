#pragma once
// The energy distance between two sets of feature windows: are these the same behaviour?
//
// Source: G. J. Székely & M. L. Rizzo, "Energy statistics: a class of statistics based on distances", J. Statistical
// Planning and Inference 143 (2013), sections 2 and 6.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "learn/fidelity/fidelity_stretch.hpp"

namespace wisp {

/// Windows of behaviour, each described by the same numbers. Windows that overlap or lie close together are alike for
/// that reason alone: they share a block.
struct FeatureWindows {
  std::size_t features = 0;
  std::vector<double> values;       ///< windows × features, row-major
  std::vector<std::size_t> blocks;  ///< one a window, ascending from 0

  std::size_t size() const { return blocks.size(); }
  std::span<const double> window(std::size_t i) const { return std::span(values).subspan(i * features, features); }
};

/// Cuts stretches into windows of `rows` rows that start every `hop` rows; the features are the rows themselves and
/// their differences from the row before. A block is as long as four windows.
///
/// Precondition: rows >= 1, hop >= 1.
FeatureWindows motion_windows(std::span<const Stretch> stretches, std::size_t rows, std::size_t hop);

/// At most `most` of the windows, evenly spread.
FeatureWindows thinned(const FeatureWindows& windows, std::size_t most);

/// Shifts and scales every feature of both by mean and standard deviation of the first; what never changes there is
/// only shifted.
void standardise(FeatureWindows& reference, FeatureWindows& other);

/// An energy distance and how likely chance alone makes one as large.
struct EnergyTest {
  double distance = 0;  ///< (2E‖X−Y‖ − E‖X−X′‖ − E‖Y−Y′‖) / (2E‖X−Y‖), in [0, 1]; 0: the same distribution
  double p_value = 1;  ///< share of random exchanges of whole blocks, this one counted, with at least this distance
};

/// Compares two sets of windows. E‖X−X′‖ runs over all pairs, a window with itself included, so the distance of two
/// samples of one distribution is above 0 by about 1/n.
///
/// Precondition: both have windows, and the same features.
EnergyTest energy_test(const FeatureWindows& x, const FeatureWindows& y, std::size_t permutations, std::uint64_t seed);

}  // namespace wisp
