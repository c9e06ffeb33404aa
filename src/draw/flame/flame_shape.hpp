#pragma once
// The shape of a flame in a picture: which pixels it covers, and how thick the glowing body is behind each.
//
// The flame is taken for a body of revolution. Where its half width is w, the chord of light at distance d from the
// edge is 2 √(d (2w − d)); and in a long strip φ = d (2w − d) / 2 solves ∇²φ = −1 with φ = 0 at the edge. So half the
// chord is √(2φ) with φ solved inside the outline, whatever its shape: smooth everywhere, no medial axis to find, and
// moving as smoothly as the outline does.

#include <span>
#include <vector>

#include "draw/flame/light_field.hpp"
#include "wisp/draw/flame.hpp"

namespace wisp::drawing {

/// A flame laid over a picture. Positions are the picture's pixels; `thickness` and `coverage` hold only the box.
struct FlameShape {
  PixelBox box;        ///< the part of the picture that the flame touches; zero width: there is no flame
  Plane coverage;      ///< share of each pixel inside the outline, 0 … 1
  Plane thickness;     ///< half the chord, in model units
  float thickest = 0;  ///< its largest value
  Point base;          ///< middle of the outline's base
  Point middle;        ///< centre of its light
  float reach = 0;     ///< pixels from the base to the farthest point
  float height = 0;    ///< the same in model units
  float area = 0;      ///< in square model units

  bool empty() const { return box.width == 0; }
};

/// What can be said of an outline without laying it over a picture: base, middle, reach, height and area.
FlameShape measured_shape(std::span<const Point> outline, const FlameScene& scene, float scale);

/// Lays an outline (model units) over a picture of that size, `scale` times its size about the base. Points that are
/// not finite are left out; the base is drawn as a drop around the wick, down to `cap` units under the base's middle.
FlameShape flame_shape(std::span<const Point> outline, const FlameScene& scene, float scale, float cap, int width,
                       int height);

}  // namespace wisp::drawing
