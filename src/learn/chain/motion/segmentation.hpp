#pragma once
// Segmentation of motion at critical events: zeros or extrema of a channel or of a signal derived from the motion.
//
// Source: L.-M. Reissell and D. K. Pai (2001), section 4.1.1 (a leaf is cut where its forward speed in its plane is 0).

#include <span>
#include <string>
#include <vector>

#include "learn/chain/motion/motion.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/chain_recipe.hpp"

namespace wisp::chain {

struct SegmentationOptions {
  EventSpec event{};
  double min_seconds = 0.04;  ///< ≥ 0: minimum time between events, else the later is dropped
  double debounce = 0.1;  ///< ≥ 0, in standard deviations of the signal: minimum excursion on both sides of a zero, or
                          ///< from an extremum
};

/// A piece of motion between two events: [begin, end] in fractional rows of its piece.
struct Segment {
  std::size_t piece = 0;
  double begin = 0;
  double end = 0;
  int steps = 1;  ///< duration in whole rows; segments of a piece add up to the rows between its events
};

inline SegmentationOptions segmentation_of(const ChainRecipe& recipe) {
  return {recipe.event, recipe.min_seconds, recipe.debounce};
}

struct Segmentation {
  std::vector<Segment> segments;  ///< in order; consecutive segments of the same piece adjoin
  std::vector<std::string> warnings;
  std::size_t pieces_without = 0;  ///< pieces with fewer than two events
};

/// Fractional rows of the events of one signal. `deviation` is the signal's standard deviation.
std::vector<double> event_rows(std::span<const double> signal, double rate_hz, double deviation,
                               const SegmentationOptions& options);

/// Cuts motion into segments. Rows before a piece's first event and after its last are dropped.
/// Errors: a signal that is neither a channel nor derived, or has missing samples; one that needs a missing
/// orientation; an option out of range; no segment.
Result<Segmentation> segment(const Motion& motion, std::span<const Recording> recordings,
                             const SegmentationOptions& options);

/// Splits values per segment into one list per piece.
template <class T>
std::vector<std::vector<T>> by_stretch(std::span<const Segment> segments, std::span<const T> values) {
  std::vector<std::vector<T>> stretches;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    if (k == 0 || segments[k].piece != segments[k - 1].piece) stretches.emplace_back();
    stretches.back().push_back(values[k]);
  }
  return stretches;
}

/// Whether height is bounded: its variance within windows of a quarter of the longest stretch is less than 1.7 times
/// that within a sixteenth. The ratio is 1 for bounded motion, 4 for a random walk, 16 for a fall. False where a
/// quarter is shorter than 8 segments of mean duration. Precondition: `segments` are of the motion, at least one.
bool height_is_bounded(const Motion& motion, std::span<const Segment> segments);

}  // namespace wisp::chain
