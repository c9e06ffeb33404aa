#pragma once
// The wick: a short, bent, tapering cord between the candle and the flame.

#include "draw/flame/light_field.hpp"
#include "wisp/draw/flame.hpp"

namespace wisp::drawing {

/// A wick laid over a picture.
struct Wick {
  PixelBox box;     ///< the part of the picture that it touches; zero width: none
  Plane coverage;   ///< share of each pixel of the box inside it
  Point root;       ///< where it leaves the wax, pixels
  Point end;        ///< its upper end, pixels
  float width = 0;  ///< pixels, at its root

  bool empty() const { return box.width == 0; }
};

Wick make_wick(const FlameScene& scene, const FlameStyle& style, int width, int height);

/// The wick's coverage at a pixel of the picture; 0 outside its box.
float wick_at(const Wick& wick, int x, int y);

}  // namespace wisp::drawing
