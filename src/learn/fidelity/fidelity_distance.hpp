#pragma once
// Distances between two sets of stretches: of windows of motion and of spectra, of tails, and the longest copy.
//
// Sources: G. J. Székely & M. L. Rizzo, "Energy statistics: a class of statistics based on distances", J. Statistical
// Planning and Inference 143 (2013), sections 2 and 6.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "learn/fidelity/fidelity_stretch.hpp"

namespace wisp {

/// Windows of behaviour, each described by the same features. Windows that overlap or lie close together are
/// correlated: they belong to one block.
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

/// Distances of two sides over long windows (two seconds: bursts, dives and drift). NaN where there are too few data.
struct LongDistances {
  double motion = 0;   ///< normalised energy distance of windows of all channels and their differences
  double spectra = 0;  ///< the same of their log spectra in geometric bands: whether each rhythm is there
  double tails = 0;  ///< mean over channels and percentiles (99, 99.9) of |ln| of the ratio of the sizes of the second
                     ///< differences: 0.1 is ten per cent more or less violent
};

/// How to compare long windows.
struct LongOptions {
  double rate_hz = 0;
  double window_seconds = 2;
  std::size_t max_windows = 300;  ///< ≥ 2, a side
};

/// Compares two sides. Rows of motion windows are thinned to 15 a second: faster motion is what spectra are for.
///
/// Precondition: the same channels on both sides.
LongDistances long_distances(std::span<const Stretch> a, std::span<const Stretch> b, const LongOptions& options);

/// Cuts stretches into windows of `rows` rows that start every `hop` rows; the features are the logarithms of the power
/// in at most 13 geometric bands of each channel, its mean removed, through a Hann window.
///
/// Precondition: rows >= 8 and even, hop >= 1.
FeatureWindows spectral_windows(std::span<const Stretch> stretches, std::size_t rows, std::size_t hop);

/// The longest run of consecutive rows in `synthesized` that repeats consecutive rows of `real`: every channel within
/// `tolerance` times its standard deviation over `real`. Returns its rows.
///
/// Precondition: the same channels on both sides; tolerance >= 0.
std::size_t longest_verbatim_run(std::span<const Stretch> real, std::span<const Stretch> synthesized, double tolerance);

}  // namespace wisp
