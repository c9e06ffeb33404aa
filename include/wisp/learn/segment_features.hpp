#pragma once
// What tells segments apart: a short vector of numbers for each.
//
// Source: section 4.1.3 of the paper: velocities at both ends, length, and direction of the line between the ends.

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/learn/motion.hpp"
#include "wisp/learn/segmentation.hpp"

namespace wisp {

/// Which numbers.
struct FeatureChoice {
  bool velocity = true;      ///< at both ends: 6 numbers
  bool length = true;        ///< of the line between the ends: 1
  bool direction = true;     ///< of that line, a unit vector: 3
  bool spin = false;         ///< angular velocity at both ends: 6; needs orientation
  bool tilt = false;         ///< the body's normal at both ends: 6; needs orientation
  bool duration = false;     ///< 1
  bool heading_free = true;  ///< vectors as seen along the segment's own direction over ground; otherwise the world's
};

/// `velocity,length,direction,spin,tilt,duration` or some of them.
/// Errors: an empty list, another word.
Result<FeatureChoice> parse_features(std::string_view text);

struct FeatureTable {
  std::size_t features = 0;
  std::vector<double> values;  ///< segments × features, row-major, each feature standardised: mean 0, deviation 1

  std::size_t rows() const { return features == 0 ? 0 : values.size() / features; }
};

/// Direction over ground of the line between a segment's ends, as an angle from x; 0 where it has none.
double heading_of(const Motion& motion, const Segment& segment);

/// A feature that does not vary is 0.
/// Errors: features that need orientation where there is none, no feature at all.
Result<FeatureTable> segment_features(const Motion& motion, std::span<const Segment> segments,
                                      const FeatureChoice& choice);

}  // namespace wisp
