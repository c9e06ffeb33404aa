#pragma once
// The light that a flame gives off, pixel by pixel.

#include "draw/flame/flame_shape.hpp"
#include "draw/flame/light_field.hpp"

namespace wisp::drawing {

/// What dims or colours a flame as a whole.
struct FlameMood {
  float brightness = 1;
  float soot = 1;  ///< 0: blue gas only (re-ignition, decay, tiny), 1: a full yellow flame
};

/// Adds the flame's light to the field. `shade` dims it where something dark stands in it (the wick), 0 … 1, over the
/// shape's box; an empty plane dims nothing.
void add_flame_light(LightField& field, const FlameShape& shape, const FlameMood& mood, const FlameStyle& style,
                     const Plane& shade);

}  // namespace wisp::drawing
