#pragma once
// Smoke from a wick that went out: a ribbon that rises straight, then folds and curls as it slows and spreads.

#include <span>

#include "draw/flame/candle.hpp"

namespace wisp::drawing {

/// Draws the smoke that left the wick since it went out, lit by the room and by the lamps. Nothing where the candle
/// never went out, or all smoke has gone.
///
/// Precondition: the scene's fields are in their ranges.
void draw_smoke(Image& image, const FlameScene& scene, Point wick_end, std::span<const Lamp> lamps);

}  // namespace wisp::drawing
