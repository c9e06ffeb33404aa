#pragma once
// Where motion is cut: at critical events, zeros or extrema of a channel or of a signal derived from the motion.
//
// Source: section 4.1.1 of the paper (a leaf is cut where it stalls: its forward speed in its own plane is zero).

#include <span>
#include <string>
#include <vector>

#include "learn/chain/motion/motion.hpp"
#include "learn/chain/motion/segmentation.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/chain_recipe.hpp"

namespace wisp::chain {

struct SegmentationOptions {
  EventSpec event{};
  double min_seconds = 0.04;  ///< ≥ 0: events nearer to the one before are left out; 0.04 is 2 frames of 60
  double debounce = 0.1;  ///< ≥ 0: how far, in standard deviations of the signal, it must go beyond a zero on both
                          ///< sides, or away from an extremum, before that counts
};

/// A piece of motion between two events: [begin, end] in rows of its piece, between samples.
struct Segment {
  std::size_t piece = 0;
  double begin = 0;
  double end = 0;
  int steps = 1;  ///< whole rows that it stands for; those of a piece's segments add up to the rows between its events
};

/// What a recipe says of it.
inline SegmentationOptions segmentation_of(const ChainRecipe& recipe) {
  return {recipe.event, recipe.min_seconds, recipe.debounce};
}

struct Segmentation {
  std::vector<Segment> segments;  ///< in order; one whose piece is that of the one before follows it
  std::vector<std::string> warnings;
  std::size_t pieces_without = 0;  ///< pieces with fewer than two events
};

/// The events of one signal, in rows, between samples. `deviation` is the signal's standard deviation.
std::vector<double> event_rows(std::span<const double> signal, double rate_hz, double deviation,
                               const SegmentationOptions& options);

/// Cuts motion into segments. Stretches before a piece's first event and after its last are left out.
/// Errors: a signal that is neither a channel nor derived, one that needs orientation where there is none, an option
/// out of range, no segment at all.
Result<Segmentation> segment(const Motion& motion, std::span<const Recording> recordings,
                             const SegmentationOptions& options);

/// Values of segments, one each, apart where a segment does not follow the one before it.
template <class T>
std::vector<std::vector<T>> by_stretch(std::span<const Segment> segments, std::span<const T> values) {
  std::vector<std::vector<T>> stretches;
  for (std::size_t k = 0; k < segments.size(); ++k) {
    if (k == 0 || segments[k].piece != segments[k - 1].piece) stretches.emplace_back();
    stretches.back().push_back(values[k]);
  }
  return stretches;
}

/// Whether heights vary hardly more within a quarter of the longest stretch than within a sixteenth. By the variance
/// within a window: it is the same in both for what is bounded, four times as large for a random walk, sixteen times
/// for what falls. False where a quarter has fewer than 8 usual segments.
///
/// Precondition: segments are of the motion, not none.
bool height_is_bounded(const Motion& motion, std::span<const Segment> segments);

}  // namespace wisp::chain
