#pragma once
// How far rows jump where segments are joined.

#include <cstddef>
#include <span>
#include <vector>

#include "learn/chain/motion/motion.hpp"
#include "learn/chain/motion/segmentation.hpp"

namespace wisp::chain {

/// How far rows at joins are from where the two rows before them, going on as they did, would lead; over the 99th
/// percentile of the same in the recording, joins or not.
struct JoinJumps {
  double percentile_99 = 0;  ///< of all joins
  double median = 0;
  double share_above = 0;  ///< of jumps above the recording's 99th percentile; 0.01 where joins are like anything else
};

/// At joins of the synthesized falls, and at the recording's own events, which nobody joined.
struct JoinDefect {
  JoinJumps position;
  JoinJumps rotation;  ///< zeros without orientation
  JoinJumps position_floor;
  JoinJumps rotation_floor;
};

/// `joins`: rows of each piece of `made` at which a segment was joined.
JoinDefect join_defect(const Motion& real, std::span<const Segment> segments, const Motion& made,
                       std::span<const std::vector<std::size_t>> joins);

}  // namespace wisp::chain
