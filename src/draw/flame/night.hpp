#pragma once
// The dark room behind candles.

#include <algorithm>

#include "draw/tone.hpp"

namespace wisp::drawing {

/// Light of the room at a row of a picture of that height: cold above, a trace of warmth below.
inline Light night_light(float row, int height) {
  constexpr Light kSky{0.0022F, 0.0032F, 0.0082F};
  constexpr Light kFloor{0.0056F, 0.0042F, 0.0048F};
  const float down = row / static_cast<float>(std::max(1, height - 1));
  return (1 - down) * kSky + down * kFloor;
}

}  // namespace wisp::drawing
