#pragma once
// Whether what moves stays between a floor and a ceiling, as a ball that bounces or a bird in a hall, or falls, climbs
// or wanders.

#include <span>

#include "learn/chain/motion/motion.hpp"
#include "learn/chain/segments/segmentation.hpp"

namespace wisp::chain {

/// Whether heights vary hardly more over 32 usual segments than over 8. By the variance within a window: it is the same
/// there for what is bounded, four times as large for a random walk, sixteen times for what falls. False where no
/// stretch is long enough to say.
///
/// Precondition: segments are of the motion, not none.
bool height_is_bounded(const Motion& motion, std::span<const Segment> segments);

}  // namespace wisp::chain
