#pragma once
// Stretches: consecutive complete rows of some channels, which measures of behaviour compare; and random order that is
// the same on every machine.

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

}  // namespace wisp
