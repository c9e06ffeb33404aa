#pragma once
// Which segments join which with the least to smooth over.

#include <cstdint>
#include <span>
#include <vector>

#include "learn/chain/motion/segmentation.hpp"

namespace wisp::chain {

struct JoinOptions {
  bool heading_free = true;
  bool bounded_height = false;  ///< a successor begins about as high as the segment before it ends
  int breadth = 4;              ///< successors of each segment and mode, > 0
};

/// For each segment and mode those others of the mode whose beginning is nearest to its end, nearest first (repeated
/// where there are fewer): by attitude, velocity and angular velocity, in the body's own axes where heading does not
/// count, each over its standard deviation. Without orientation by velocity and its change. A mode's only segment
/// follows itself.
///
/// Precondition: each of the modes has a segment, and segments are in their order.
std::vector<std::uint16_t> best_successors(const Motion& motion, std::span<const Segment> segments,
                                           std::span<const std::uint16_t> mode, const JoinOptions& options);

}  // namespace wisp::chain
