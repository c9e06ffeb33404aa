#pragma once
// How well an outline covers a thing: intersection over union of the spline's filled area with a mask that anyone can
// compute: the channel above the level, its largest region, holes filled. Shared by tests and benchmarks.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "capture/vision/region.hpp"
#include "capture/vision/spline_table.hpp"
#include "wisp/capture/vision/picture.hpp"

namespace wisp::support {

/// One byte a pixel, 1 inside.
struct Mask {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> inside;
  std::uint8_t& at(int x, int y) { return inside[static_cast<std::size_t>(y) * width + x]; }
  std::uint8_t at(int x, int y) const { return inside[static_cast<std::size_t>(y) * width + x]; }
};

/// Spreads `value` from the pixels in `open` to all connected pixels that hold `over`.
inline void flood(Mask& mask, std::vector<PixelPosition> open, std::uint8_t over, std::uint8_t value, bool corners) {
  while (!open.empty()) {
    const PixelPosition p = open.back();
    open.pop_back();
    if (p.x < 0 || p.y < 0 || p.x >= mask.width || p.y >= mask.height || mask.at(p.x, p.y) != over) continue;
    mask.at(p.x, p.y) = value;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if ((dx != 0 || dy != 0) && (corners || dx == 0 || dy == 0)) open.push_back({p.x + dx, p.y + dy});
      }
    }
  }
}

/// The largest region above the level, holes filled. `plane` is one byte a pixel, brighter inside.
inline Mask region_mask(const ImageView& plane, int level) {
  RegionFinder finder;
  const auto regions = finder.find(plane, level, 1);
  Mask mask{plane.width, plane.height, std::vector<std::uint8_t>(static_cast<std::size_t>(plane.width) * plane.height)};
  if (regions.empty()) return mask;
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) mask.at(x, y) = plane.at(x, y) > level ? 1 : 0;
  }
  flood(mask, {{regions[0].seed_x, regions[0].seed_y}}, 1, 2, true);
  for (std::uint8_t& value : mask.inside) value = value == 2;
  std::vector<PixelPosition> border;
  for (int x = 0; x < mask.width; ++x) border.insert(border.end(), {{x, 0}, {x, mask.height - 1}});
  for (int y = 0; y < mask.height; ++y) border.insert(border.end(), {{0, y}, {mask.width - 1, y}});
  flood(mask, border, 0, 3, false);
  for (std::uint8_t& value : mask.inside) value = value != 3;
  return mask;
}

/// Pixels whose centre lies inside the curve closed by a straight line (even-odd).
inline Mask curve_mask(const SplineTable& table, std::span<const double> controls, int width, int height) {
  Mask mask{width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width) * height)};
  const std::vector<CurvePoint> line = curve_polyline(table, controls, 800);
  std::vector<std::vector<double>> crossings(height);
  for (std::size_t k = 0; k < line.size(); ++k) {
    CurvePoint a = line[k], b = line[(k + 1) % line.size()];
    if (a.y > b.y) std::swap(a, b);
    const int last = static_cast<int>(std::min(std::ceil(b.y) - 1, height - 1.0));
    for (int y = static_cast<int>(std::max(std::ceil(a.y), 0.0)); y <= last; ++y) {
      crossings[y].push_back(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
    }
  }
  for (int y = 0; y < height; ++y) {
    std::vector<double>& cuts = crossings[y];
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t k = 0; k + 1 < cuts.size(); k += 2) {
      const int last = static_cast<int>(std::min(std::floor(cuts[k + 1]), width - 1.0));
      for (int x = static_cast<int>(std::max(std::ceil(cuts[k]), 0.0)); x <= last; ++x) mask.at(x, y) = 1;
    }
  }
  return mask;
}

/// Intersection over union.
inline double overlap(const Mask& a, const Mask& b) {
  std::int64_t both = 0, either = 0;
  for (std::size_t k = 0; k < a.inside.size(); ++k) {
    both += a.inside[k] & b.inside[k];
    either += a.inside[k] | b.inside[k];
  }
  return either == 0 ? 0 : static_cast<double>(both) / static_cast<double>(either);
}

}  // namespace wisp::support
