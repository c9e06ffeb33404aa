#pragma once
// What the segments of one recorded stretch have in common: a large disc of paper glides longer than a small one, and
// goes on to do so. Segments of different bodies that follow each other would make every fall an average of all.
//
// Source: the reliability of group means, as in S. E. Shrout & J. L. Fleiss, Intraclass correlations, Psychological
// Bulletin 86 (1979).

#include <array>
#include <span>
#include <vector>

#include "learn/chain/motion/motion.hpp"
#include "learn/chain/segments/segmentation.hpp"

namespace wisp::chain {

/// Speed over ground, descent and duration: means over the segments of a stretch, less the mean over all segments.
inline constexpr std::size_t kTraits = 3;
using Traits = std::array<double, kTraits>;

/// Of every segment those of its stretch, each over its standard deviation within stretches and times its reliability:
/// the share of the variance among stretches that is not due to chance, 0 where all stretches are alike.
///
/// Precondition: at least one segment; segments in order, those of one piece one after the other.
std::vector<Traits> segment_traits(const Motion& motion, std::span<const Segment> segments);

}  // namespace wisp::chain
