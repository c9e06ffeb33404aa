#pragma once
// What may be set of a playing chain, of all instances of a bank alike.

namespace wisp {

/// Positions are clamped to this many metres from the origin: single precision can't place a body beyond it.
inline constexpr float kFarthest = 1e6f;

/// Lower than anything falls.
inline constexpr float kNoGround = -4.0f * kFarthest;

struct ChainSettings {
  float ground = kNoGround;
};

}  // namespace wisp
