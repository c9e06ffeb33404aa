#pragma once
// Distances between two sets of stretches: windows of motion and of spectra, tails, and the longest verbatim copy.
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

/// A random number below `bound`. The modulo's bias is below bound / 2^64.
inline std::size_t below(std::mt19937_64& random, std::size_t bound) { return random() % bound; }

/// Shuffles by Fisher–Yates, equally on every machine: the algorithm of std::shuffle is implementation-defined.
template <class T>
void shuffle(std::span<T> items, std::mt19937_64& random) {
  for (std::size_t left = items.size(); left > 1; --left) std::swap(items[left - 1], items[below(random, left)]);
}

/// Consecutive rows of one episode without missing samples.
struct Stretch {
  std::size_t channels = 0;
  std::vector<double> values;  ///< rows × channels, row-major

  std::size_t rows() const { return channels == 0 ? 0 : values.size() / channels; }
  std::span<const double> row(std::size_t t) const { return std::span(values).subspan(t * channels, channels); }
  double operator()(std::size_t t, std::size_t channel) const { return values[t * channels + channel]; }

  void add(std::span<const double> row) { values.insert(values.end(), row.begin(), row.end()); }
};

/// The maximal stretches of a recording over the named channels, in order. Errors: a missing channel.
Result<std::vector<Stretch>> stretches_of(const Recording& recording, std::span<const std::string> channels);

std::vector<std::vector<double>> channel_of(std::span<const Stretch> stretches, std::size_t channel);

std::size_t total_rows(std::span<const Stretch> stretches);

/// Cuts longer stretches into pieces of `max_rows` rows; a shorter remainder is kept. Precondition: max_rows >= 1.
std::vector<Stretch> cut_to(std::span<const Stretch> stretches, std::size_t max_rows);

/// Stretches before and after half of all rows; a stretch across that point is cut in two.
struct Halves {
  std::vector<Stretch> first;
  std::vector<Stretch> second;
};
Halves halves_of(std::span<const Stretch> stretches);

/// Every stretch with its rows in random order: the same frames without their dynamics.
/// The same seed gives the same order on every machine.
std::vector<Stretch> shuffled(std::span<const Stretch> stretches, std::uint64_t seed);

/// Windows of behaviour, each described by the same features.
struct FeatureWindows {
  std::size_t features = 0;
  std::vector<double> values;  ///< windows × features, row-major

  std::size_t size() const { return features == 0 ? 0 : values.size() / features; }
  std::span<const double> window(std::size_t i) const { return std::span(values).subspan(i * features, features); }
};

/// Cuts stretches into windows of `rows` rows that start every `hop` rows; the features are the rows themselves and
/// their differences from the row before. Precondition: rows >= 1, hop >= 1.
FeatureWindows motion_windows(std::span<const Stretch> stretches, std::size_t rows, std::size_t hop);

/// At most `most` of the windows, equally spaced.
FeatureWindows thinned(const FeatureWindows& windows, std::size_t most);

/// Standardises every feature of both sets by the reference's mean and standard deviation; features constant in the
/// reference are divided by its largest standard deviation instead.
void standardise(FeatureWindows& reference, FeatureWindows& other);

/// Normalised energy distance (2E‖X−Y‖ − E‖X−X′‖ − E‖Y−Y′‖) / (2E‖X−Y‖), in [0, 1]; 0: equal distributions. E‖X−X′‖
/// includes the pair of a window with itself, so two samples of one distribution have a distance of about 1/n.
///
/// Precondition: neither is empty, and both have the same features.
double energy_distance(const FeatureWindows& x, const FeatureWindows& y);

/// Distances of two sides: over windows of two seconds (bursts, dives, drift), and of tails. NaN for too few data.
struct LongDistances {
  double motion = 0;   ///< normalised energy distance of windows of all channels and their differences
  double spectra = 0;  ///< energy distance of the windows' log spectra in geometric bands, sensitive to each rhythm
  double tails = 0;    ///< mean |ln(b / a)| over channels and over the percentiles 99 and 99.9 of |second difference|:
                       ///< 0.1 is 10 % more or less violent
};

/// Compares two sides, by at most 300 windows of each. Motion windows keep every n-th row, with the largest n that
/// leaves 15 rows a second. With `motion_only` the others are NaN. Precondition: both sides have the same channels.
LongDistances long_distances(std::span<const Stretch> a, std::span<const Stretch> b, double rate_hz,
                             bool motion_only = false);

/// Windows of `rows` rows that start every `hop` rows. Features are logarithms of the power in at most 13 geometric
/// bands per channel, after removing the mean and applying a Hann window. Precondition: rows >= 8 and even, hop >= 1.
FeatureWindows spectral_windows(std::span<const Stretch> stretches, std::size_t rows, std::size_t hop);

/// Number of rows of the longest run in `synthesized` that repeats consecutive rows of `real`: every channel within
/// `tolerance` standard deviations (over `real`). Precondition: both sides have the same channels; tolerance >= 0.
std::size_t longest_verbatim_run(std::span<const Stretch> real, std::span<const Stretch> synthesized, double tolerance);

}  // namespace wisp
