#pragma once
// A mode as a chain of its own: its segments cut in two, the halves sorted into kinds. The chains of all modes are
// written as one, whose modes are (mode, half, kind), so that it is played as any other.

#include <cstdint>
#include <span>
#include <vector>

#include "learn/chain/motion/motion.hpp"
#include "learn/chain/segments/segment_features.hpp"
#include "learn/chain/segments/segmentation.hpp"
#include "wisp/base/result.hpp"

namespace wisp::chain {

struct ModeParts {
  std::vector<Segment> segments;       ///< halves, in order
  std::vector<std::uint16_t> cluster;  ///< of each: its kind among all
  int modes = 0;                       ///< kinds in all
  std::vector<std::uint16_t> parent;   ///< of each kind: the mode that it is of
};

/// Errors: as segment_features() and k_means(); more kinds than a chain can have.
Result<ModeParts> mode_parts(const Motion& motion, std::span<const Segment> segments,
                             std::span<const std::uint16_t> cluster, int modes, const FeatureChoice& features,
                             std::uint64_t seed);

}  // namespace wisp::chain
