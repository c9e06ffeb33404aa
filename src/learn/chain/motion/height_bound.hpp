#pragma once
// Whether what moves stays between a floor and a ceiling, as a ball that bounces or a bird in a hall, or falls, climbs
// or wanders.

#include <span>

#include "learn/chain/motion/motion.hpp"
#include "learn/chain/motion/segmentation.hpp"

namespace wisp::chain {

/// Whether heights vary hardly more within a quarter of the longest stretch than within a sixteenth. By the variance
/// within a window: it is the same in both for what is bounded, four times as large for a random walk, sixteen times
/// for what falls. False where a quarter has fewer than 8 usual segments.
///
/// Precondition: segments are of the motion, not none.
bool height_is_bounded(const Motion& motion, std::span<const Segment> segments);

}  // namespace wisp::chain
