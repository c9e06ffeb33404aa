#pragma once
// What may be set of a playing chain, of all instances of a bank alike.

#include <cstdint>
#include <limits>

namespace wisp {

/// Positions are clamped to this many metres from the origin: single precision can't place a body beyond it.
inline constexpr float kFarthest = 1e6f;

/// Lower than anything falls.
inline constexpr float kNoGround = -4.0f * kFarthest;

/// The temperature of a chain that chooses as it was learned to.
inline constexpr float kAsLearned = -1.0f;

/// Hotter than this, what joins better is no likelier in single precision.
inline constexpr float kHottest = 1e9f;

struct ChainSettings {
  float ground = kNoGround;
  std::int32_t history = 0;        ///< most modes to look back; 0: as learned
  float temperature = kAsLearned;  ///< as ChainFacet::set_temperature()
};

}  // namespace wisp
