#pragma once
// Which segments join which with the least to smooth over.

#include <cstdint>
#include <span>
#include <vector>

#include "learn/chain/segments/segment_moments.hpp"

namespace wisp::chain {

/// For each segment and mode the `breadth` segments of that mode whose beginning is nearest to its end, nearest first
/// (a mode with fewer repeats them). A segment does not follow itself where its mode has others. Those that a walk
/// would play too often give way to others, as in balanced_successors(); `weight` says how many a segment stands for:
/// one of two is looked for twice as far away. `chances`, segments × modes, say how likely it is to go on with each
/// mode.
///
/// Precondition: every mode below `modes` has a segment.
std::vector<std::uint16_t> best_successors(const SegmentMoments& moments, std::span<const std::uint16_t> mode,
                                           int modes, int breadth, std::span<const double> weight,
                                           std::span<const double> chances);

}  // namespace wisp::chain
