#pragma once
// Which segments join which with the least to smooth over.

#include <cstdint>
#include <span>
#include <vector>

#include "learn/chain/motion/motion.hpp"
#include "learn/chain/segments/segment_moments.hpp"
#include "learn/chain/segments/segmentation.hpp"
#include "wisp/model/chain.hpp"

namespace wisp::chain {

struct SuccessorOptions {
  bool heading_free = true;
  int breadth = 4;  ///< > 0: successors for each segment and mode
  ChainBlend blend{};
};

/// For each segment and mode the `breadth` segments of that mode whose beginning is nearest to its end, nearest first
/// (a mode with fewer repeats them). A segment does not follow itself where its mode has others. Those that a walk
/// would play too often give way to others, as in balanced_successors(); `weight` says how many a segment stands for:
/// one of two is looked for twice as far away. `chances`, segments × modes, say how likely it is to go on with each
/// mode.
///
/// Precondition: every mode below `modes` has a segment.
std::vector<std::uint16_t> best_successors(const Motion& motion, std::span<const Segment> segments,
                                           const SegmentMoments& moments, std::span<const std::uint16_t> mode,
                                           int modes, const SuccessorOptions& options, std::span<const double> weight,
                                           std::span<const double> chances);

}  // namespace wisp::chain
