#include "draw/flame/wick.hpp"

#include <algorithm>
#include <cmath>

#include "draw/cairo.hpp"
#include "draw/random.hpp"

namespace wisp::drawing {
namespace {

// Share of each pixel inside a polygon, over a box of the picture.
Plane filled(std::span<const Point> polygon, PixelBox box) {
  const CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_A8, box.width, box.height));
  {
    const CairoContext context(cairo_create(surface.get()));
    cairo_translate(context.get(), -box.x, -box.y);
    for (const Point p : polygon) cairo_line_to(context.get(), p.x, p.y);
    cairo_fill(context.get());
  }
  cairo_surface_flush(surface.get());
  const unsigned char* data = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  Plane plane(box.width, box.height);
  for (int y = 0; y < box.height; ++y) {
    for (int x = 0; x < box.width; ++x) {
      plane.row(y)[x] = static_cast<float>(data[static_cast<std::ptrdiff_t>(y) * stride + x]) / 255;
    }
  }
  return plane;
}

PixelBox box_of(std::span<const Point> points, int width, int height) {
  float left = points[0].x, right = left, top = points[0].y, bottom = top;
  for (const Point p : points) {
    left = std::min(left, p.x);
    right = std::max(right, p.x);
    top = std::min(top, p.y);
    bottom = std::max(bottom, p.y);
  }
  const int x0 = std::max(0, static_cast<int>(std::floor(left)));
  const int y0 = std::max(0, static_cast<int>(std::floor(top)));
  const int x1 = std::min(width, static_cast<int>(std::ceil(right)));
  const int y1 = std::min(height, static_cast<int>(std::ceil(bottom)));
  if (x0 >= x1 || y0 >= y1) return {};
  return {x0, y0, x1 - x0, y1 - y0};
}

}  // namespace

Wick make_wick(const FlameScene& scene, const FlameStyle& style, int width, int height) {
  Wick wick;
  const float unit = scene.pixels_per_unit;
  const float length = style.wick_height * unit;
  if (length <= 0) return wick;
  wick.width = 0.032F * unit;
  wick.root = {scene.base.x, scene.base.y + style.wick_gap * unit};
  // Wicks curl over as they burn; which way is chance.
  const float bend = (random_at(scene.seed, 0) < 0.5F ? -1.0F : 1.0F) * (0.16F + 0.16F * random_at(scene.seed, 1));
  constexpr int kSteps = 14;
  std::vector<Point> left;
  std::vector<Point> right;
  for (int k = 0; k <= kSteps; ++k) {
    const float s = static_cast<float>(k) / kSteps;
    const Point p{wick.root.x + bend * length * s * s, wick.root.y - length * s};
    const float half = 0.5F * wick.width * (1 - 0.42F * s) * (k == kSteps ? 0.55F : 1.0F);
    const float slope = 2 * bend * s;
    const float norm = std::sqrt(1 + slope * slope);
    left.push_back({p.x - half / norm, p.y - half * slope / norm});
    right.push_back({p.x + half / norm, p.y + half * slope / norm});
    wick.end = p;
  }
  left.insert(left.end(), right.rbegin(), right.rend());
  wick.box = box_of(left, width, height);
  if (!wick.empty()) wick.coverage = filled(left, wick.box);
  return wick;
}

float wick_at(const Wick& wick, int x, int y) {
  const int column = x - wick.box.x;
  const int row = y - wick.box.y;
  if (column < 0 || row < 0 || column >= wick.box.width || row >= wick.box.height) return 0;
  return wick.coverage.row(row)[column];
}

}  // namespace wisp::drawing
