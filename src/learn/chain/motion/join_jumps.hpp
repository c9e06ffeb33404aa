#pragma once
// How far rows of recorded motion jump.

#include <cstddef>

#include "learn/chain/motion/motion.hpp"

namespace wisp::chain {

/// A row's jump: how far it is from where the two before it, going on as they did, would lead.
struct Jump {
  double position = 0;
  double rotation = 0;  ///< 0 without orientation
};

/// The jump of a row of recorded motion. Precondition: row >= 2.
Jump jump_at(const MotionPiece& piece, std::size_t row);

}  // namespace wisp::chain
