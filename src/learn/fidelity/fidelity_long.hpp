#pragma once
// What a viewer sees: windows of two seconds, where bursts, dives and drift are, and the tails beside the means.

#include <cstddef>
#include <cstdint>
#include <span>

#include "learn/fidelity/fidelity_energy.hpp"
#include "learn/fidelity/fidelity_stretch.hpp"

namespace wisp {

/// Distances of two sides over long windows. NaN where there are too few data.
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
/// Precondition: rows >= 8, hop >= 1.
FeatureWindows spectral_windows(std::span<const Stretch> stretches, std::size_t rows, std::size_t hop);

}  // namespace wisp
