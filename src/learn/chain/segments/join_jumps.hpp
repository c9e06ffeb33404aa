#pragma once
// How far a join makes rows jump, as the bank would play it: foreseen for two recorded segments.

#include <span>
#include <vector>

#include "learn/chain/motion/motion.hpp"
#include "learn/chain/segments/segmentation.hpp"
#include "wisp/model/chain.hpp"

namespace wisp::chain {

/// A row's jump: how far it is from where the two before it, going on as they did, would lead.
struct Jump {
  double position = 0;
  double rotation = 0;  ///< 0 without orientation
};

/// The jump of a row of recorded motion. Precondition: row >= 2.
Jump jump_at(const MotionPiece& piece, std::size_t row);

/// The share of rows' jumps that is below what is returned, of position and of rotation each.
Jump usual_jump(const Motion& motion, double share);

/// Foresees joins of segments that begin and end on rows.
class JoinForesight {
 public:
  JoinForesight(const Motion& motion, std::span<const Segment> segments, bool heading_free, const ChainBlend& blend);

  /// The greatest jump of the first rows after a join, in units of the recording's 99th percentile.
  double jump(std::size_t from, std::size_t to) const;

 private:
  const Motion& motion_;
  std::span<const Segment> segments_;
  bool heading_free_;
  ChainBlend blend_;
  Jump usual_;
};

}  // namespace wisp::chain
