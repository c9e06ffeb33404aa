#pragma once
// What tells segments apart: a short vector of numbers for each.
//
// Source: section 4.1.3 of the paper: velocities at both ends, length, and direction of the line between the ends.

#include <cstddef>
#include <span>
#include <vector>

#include "learn/chain/motion/motion.hpp"
#include "learn/chain/motion/segmentation.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/chain_recipe.hpp"

namespace wisp::chain {

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

}  // namespace wisp::chain
