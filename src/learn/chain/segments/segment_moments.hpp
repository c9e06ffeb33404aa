#pragma once
// How a body moves at the moment of a join, as numbers whose distances say how ill two segments join.

#include <cstddef>
#include <span>
#include <vector>

#include "learn/chain/motion/motion.hpp"
#include "learn/chain/segments/segmentation.hpp"

namespace wisp::chain {

/// Attitude, velocity and angular velocity, in the body's own axes where heading does not count, each over its standard
/// deviation. Without attitude: velocity, its change, along and across the heading where that does not count, and the
/// traits of its stretch. Where height is bounded, that too.
using JoinMoment = std::vector<double>;

/// Of all segments, in their order.
struct SegmentMoments {
  std::vector<JoinMoment> starts;
  std::vector<JoinMoment> ends;
};

/// Precondition: at least one segment.
SegmentMoments segment_moments(const Motion& motion, std::span<const Segment> segments, bool heading_free,
                               bool bounded_height = false);

/// The squared distance of two moments.
double distance_of(const JoinMoment& a, const JoinMoment& b);

}  // namespace wisp::chain
