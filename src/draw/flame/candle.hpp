#pragma once
// The candle under the flame: wax that lets light through, a melted pool, the wick.

#include <span>

#include "draw/flame/wick.hpp"
#include "wisp/draw/flame.hpp"

namespace wisp::drawing {

/// A flame as others see it.
struct Lamp {
  Point place;      ///< pixel of its middle
  float power = 0;  ///< light against that of a calm flame
};

/// Draws a candle lit by its own flame and by the others.
///
/// Precondition: the fields of scene and style are in their ranges.
void draw_candle(Image& image, const FlameScene& scene, const FlameStyle& style, const Wick& wick, const Lamp& own,
                 std::span<const Lamp> others);

}  // namespace wisp::drawing
