#pragma once
// Distances between two sets of stretches: of windows of motion and of spectra, of tails, and the longest copy.
//
// Sources: G. J. Székely & M. L. Rizzo, "Energy statistics: a class of statistics based on distances", J. Statistical
// Planning and Inference 143 (2013), sections 2 and 6.

#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// A number below `bound`. The modulo's bias is below bound / 2^64.
inline std::size_t below(std::mt19937_64& random, std::size_t bound) { return random() % bound; }

/// Fisher–Yates: std::shuffle leaves its method to the library.
template <class T>
void shuffle(std::span<T> items, std::mt19937_64& random) {
  for (std::size_t left = items.size(); left > 1; --left) std::swap(items[left - 1], items[below(random, left)]);
}

/// Consecutive rows without a missing sample, all of one episode.
struct Stretch {
  std::size_t channels = 0;
  std::vector<double> values;  ///< rows × channels, row-major

  std::size_t rows() const { return channels == 0 ? 0 : values.size() / channels; }
  std::span<const double> row(std::size_t t) const { return std::span(values).subspan(t * channels, channels); }
  double operator()(std::size_t t, std::size_t channel) const { return values[t * channels + channel]; }

  /// One channel's samples.
  std::vector<double> channel(std::size_t index) const;
};

/// The maximal stretches of a recording over the named channels, in order.
/// Errors: a channel that the recording has not.
Result<std::vector<Stretch>> stretches_of(const Recording& recording, std::span<const std::string> channels);

/// Rows of all stretches together.
std::size_t total_rows(std::span<const Stretch> stretches);

/// Cuts what is longer than `max_rows` into pieces of that length; a remainder shorter than that is kept.
///
/// Precondition: max_rows >= 1.
std::vector<Stretch> cut_to(std::span<const Stretch> stretches, std::size_t max_rows);

/// Both sides of a cut in time after half of all rows; a stretch that spans it is cut in two.
struct Halves {
  std::vector<Stretch> first;
  std::vector<Stretch> second;
};
Halves halves_of(std::span<const Stretch> stretches);

/// Every stretch with its rows in random order: what the same frames would be without time.
/// The same seed gives the same order everywhere.
std::vector<Stretch> shuffled(std::span<const Stretch> stretches, std::uint64_t seed);

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

/// (2E‖X−Y‖ − E‖X−X′‖ − E‖Y−Y′‖) / (2E‖X−Y‖), in [0, 1]; 0: the same distribution. E‖X−X′‖ runs over all pairs, a
/// window with itself included, so the distance of two samples of one distribution is above 0 by about 1/n.
///
/// Precondition: both have windows, and the same features.
double energy_distance(const FeatureWindows& x, const FeatureWindows& y);

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
