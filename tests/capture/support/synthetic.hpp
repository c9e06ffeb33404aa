#pragma once
// Made pictures of a flame-like thing whose boundary is known to a fraction of a pixel.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "wisp/capture/vision/image.hpp"

namespace wisp::support {

/// One 8-bit plane that owns its pixels.
struct Plane {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;

  Plane(int w, int h, std::uint8_t value = 0) : width(w), height(h), pixels(static_cast<std::size_t>(w) * h, value) {}
  std::uint8_t& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
  ImageView view() const { return {pixels.data(), width, height, width}; }
  void fill(const Region& region, std::uint8_t value) {
    for (int y = region.y; y < region.bottom(); ++y) {
      for (int x = region.x; x < region.right(); ++x) at(x, y) = value;
    }
  }
};

/// Raises a plane to `bright` inside a shape, with an edge `blur` pixels wide whose middle is the shape's boundary:
/// `depth(x, y)` is how deep a point lies inside, in pixels.
template <class Depth>
void paint(Plane& plane, double bright, double blur, const Depth& depth) {
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) {
      const double cover = std::clamp(0.5 + depth(x, y) / blur, 0.0, 1.0);
      const double value = plane.at(x, y) + cover * (bright - plane.at(x, y));
      plane.at(x, y) = static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
    }
  }
}

/// A flame: half an ellipse below that runs out into a tip above, on a straight base, bent sideways.
struct Flame {
  double base_x = 80;  ///< middle of the base
  double base_y = 150;
  double height = 110;
  double half_width = 16;  ///< where it is widest, a third up
  double lean = 0;         ///< how far the tip lies to the right

  double middle(double y) const {
    const double up = std::clamp((base_y - y) / height, 0.0, 1.0);
    return base_x + lean * up * up;
  }

  /// Half the width at height y; 0 above the tip.
  double reach(double y) const {
    const double up = (base_y - y) / height;
    if (up < 0 || up > 1) return 0;
    if (up < 1.0 / 3) return half_width * std::sqrt(1 - std::pow(1 - 3 * up, 2) * 0.5);
    const double part = (up - 1.0 / 3) * 1.5;
    return half_width * (1 - part * part);
  }

  /// How deep a point lies inside, exact at the sides as far as these are steep.
  double depth(double x, double y) const {
    const double side = reach(y) - std::abs(x - middle(y));
    const double slope = (reach(y + 0.5) - reach(y - 0.5));
    const double steep = side / std::sqrt(1 + slope * slope);
    if (y < base_y - height) return -(base_y - height - y) - 0.5;
    return std::min(steep, base_y - y);
  }
};

/// A flame over black, perhaps with more in the picture.
inline Plane flame_picture(const Flame& flame, int width = 160, int height = 180, double bright = 230) {
  Plane plane(width, height, 8);
  paint(plane, bright, 3.0, [&](double x, double y) { return flame.depth(x, y); });
  return plane;
}

/// A flame that sways and flickers, at frame k.
inline Flame swaying(int k) {
  const double t = 0.35 * k;
  Flame flame;
  flame.lean = 12 * std::sin(t);
  flame.height = 110 + 8 * std::sin(0.73 * t + 1);
  flame.half_width = 16 + 1.5 * std::sin(1.31 * t + 2);
  return flame;
}

}  // namespace wisp::support
