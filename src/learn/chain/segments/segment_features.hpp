#pragma once
// What tells segments apart: a short vector of numbers for each.
//
// Source: section 4.1.3 of the paper: velocities at both ends, length, and direction of the line between the ends.

#include <cstddef>
#include <span>
#include <vector>

#include "learn/chain/motion/motion.hpp"
#include "learn/chain/motion/segmentation.hpp"

namespace wisp::chain {

struct FeatureTable {
  std::size_t features = 0;
  std::vector<double> values;  ///< segments × features, row-major, each feature standardised: mean 0, deviation 1

  std::size_t rows() const { return features == 0 ? 0 : values.size() / features; }
};

/// Direction over ground of the line between a segment's ends, as an angle from x; 0 where it has none.
double heading_of(const Motion& motion, const Segment& segment);

/// The rows of one segment, from whole row to whole row, as a piece of motion of its own, which begins at the origin
/// and, where heading is free, leads along x.
MotionPiece cut_out(const Motion& motion, const Segment& segment, bool heading_free);

/// Vectors are seen along the segment's own direction over ground where heading is free. A feature that does not vary
/// is 0.
FeatureTable segment_features(const Motion& motion, std::span<const Segment> segments, bool heading_free);

}  // namespace wisp::chain
