#include "draw/flame_shape.hpp"

#include <algorithm>
#include <cmath>

#include "draw/cairo.hpp"

namespace wisp::drawing {
namespace {

// No flame is larger than this many model units; it keeps absurd outlines from asking for absurd memory.
constexpr float kFarthest = 8;

// A cell of the grid that φ is solved on: a hundredth of the flame, but never finer than a pixel.
constexpr float kCellsPerUnit = 96;
constexpr int kMostCells = 240;

struct Bounds {
  float left = 0, top = 0, right = 0, bottom = 0;
  float width() const { return right - left; }
  float height() const { return bottom - top; }
};

std::vector<Point> finite_points(std::span<const Point> outline) {
  std::vector<Point> points;
  points.reserve(outline.size() + 1);
  for (const Point p : outline) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) continue;
    points.push_back({std::clamp(p.x, -kFarthest, kFarthest), std::clamp(p.y, -kFarthest, kFarthest)});
  }
  return points;
}

float area_of(std::span<const Point> points) {
  float twice = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point a = points[k];
    const Point b = points[(k + 1) % points.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return std::abs(twice) / 2;
}

Bounds bounds_of(std::span<const Point> points) {
  Bounds b{points[0].x, points[0].y, points[0].x, points[0].y};
  for (const Point p : points) {
    b.left = std::min(b.left, p.x);
    b.right = std::max(b.right, p.x);
    b.top = std::min(b.top, p.y);
    b.bottom = std::max(b.bottom, p.y);
  }
  return b;
}

float dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }

// The way that the outline runs out at one end of its base, in shares across (inwards) and down. It never flares, or a
// wide base would hang over, and never turns back up.
Point running_out(Point from, Point end, Point inwards, Point down) {
  const Point along{end.x - from.x, end.y - from.y};
  const float across = std::max(0.0F, dot(along, inwards));
  const float below = std::max({dot(along, down), 0.35F * across, 1e-6F});
  const float norm = std::hypot(across, below);
  return {across / norm, below / norm};
}

// Closes the base by a Bézier curve that goes on where the sides end: round under a wide base, a drop's point under
// one that narrows.
void append_cap(std::vector<Point>& points, float cap) {
  const Point right = points.back();
  const Point left = points.front();
  const Point base{right.x - left.x, right.y - left.y};
  const float across = std::hypot(base.x, base.y);
  if (across <= 0 || cap <= 0) return;
  const float depth = std::min(cap, 0.45F * across);
  const Point rightwards{base.x / across, base.y / across};
  const Point leftwards{-rightwards.x, -rightwards.y};
  const Point down{rightwards.y, -rightwards.x};
  // The direction over a twelfth of the outline: one sample would pass every wobble on.
  const std::size_t inner = std::max<std::size_t>(1, points.size() / 12);
  const auto handle = [&](Point from, Point end, Point inwards) {
    const Point share = running_out(from, end, inwards, down);
    const float length = std::min(4.0F / 3 * depth / share.y, 0.45F * across / std::max(share.x, 1e-6F));
    return Point{end.x + length * (share.x * inwards.x + share.y * down.x),
                 end.y + length * (share.x * inwards.y + share.y * down.y)};
  };
  const Point near_right = handle(points[points.size() - 1 - inner], right, leftwards);
  const Point near_left = handle(points[inner], left, rightwards);
  constexpr int kSteps = 20;
  for (int k = 1; k < kSteps; ++k) {
    const float s = static_cast<float>(k) / kSteps;
    const float r = 1 - s;
    const float a = r * r * r, b = 3 * r * r * s, c = 3 * r * s * s, d = s * s * s;
    points.push_back({a * right.x + b * near_right.x + c * near_left.x + d * left.x,
                      a * right.y + b * near_right.y + c * near_left.y + d * left.y});
  }
}

// Share of each cell inside the polygon; the grid's origin is (left, top), a cell is `cell` pixels.
Plane rasterised(std::span<const Point> pixels, float left, float top, float cell, int columns, int rows) {
  const CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_A8, columns, rows));
  {
    const CairoContext context(cairo_create(surface.get()));
    cairo_set_antialias(context.get(), CAIRO_ANTIALIAS_BEST);
    for (const Point p : pixels) cairo_line_to(context.get(), (p.x - left) / cell, (p.y - top) / cell);
    cairo_close_path(context.get());
    cairo_fill(context.get());
  }
  cairo_surface_flush(surface.get());
  const unsigned char* data = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  Plane plane(columns, rows);
  for (int y = 0; y < rows; ++y) {
    const unsigned char* from = data + static_cast<std::ptrdiff_t>(y) * stride;
    for (int x = 0; x < columns; ++x) plane.row(y)[x] = static_cast<float>(from[x]) / 255;
  }
  return plane;
}

// Solves ∇²φ = −1 with φ = 0 outside by red-black successive over-relaxation (Press et al., Numerical Recipes, section
// 20.5), in squared cells. A cell that is covered in part holds its share, so that φ moves with the edge and does not
// jump from cell to cell. The number of sweeps is fixed: enough for a body 40 cells wide.
Plane solve_thickness(const Plane& inside) {
  constexpr float kRelaxation = 1.78F;
  constexpr int kSweeps = 44;
  const int width = inside.width + 2;
  Plane phi(width, inside.height + 2);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int colour = 0; colour < 2; ++colour) {
      for (int y = 1; y <= inside.height; ++y) {
        float* here = phi.row(y);
        const float* above = phi.row(y - 1);
        const float* below = phi.row(y + 1);
        const float* share = inside.row(y - 1) - 1;
        for (int x = 1 + (y + colour) % 2; x <= inside.width; x += 2) {
          if (share[x] == 0) continue;
          const float solved = share[x] * 0.25F * (here[x - 1] + here[x + 1] + above[x] + below[x] + 1);
          here[x] = std::max(0.0F, here[x] + kRelaxation * (solved - here[x]));
        }
      }
    }
  }
  return phi;
}

// Bilinear value of a grid with a border of one cell, at cell coordinates (cell centres at halves).
float sampled(const Plane& bordered, float x, float y) {
  const float u = std::clamp(x + 0.5F, 0.0F, static_cast<float>(bordered.width) - 1.001F);
  const float v = std::clamp(y + 0.5F, 0.0F, static_cast<float>(bordered.height) - 1.001F);
  const int i = static_cast<int>(u);
  const int j = static_cast<int>(v);
  const float a = u - static_cast<float>(i);
  const float b = v - static_cast<float>(j);
  const float* top = bordered.row(j) + i;
  const float* bottom = bordered.row(j + 1) + i;
  return (1 - b) * ((1 - a) * top[0] + a * top[1]) + b * ((1 - a) * bottom[0] + a * bottom[1]);
}

PixelBox visible_box(const Bounds& bounds, int width, int height) {
  const int left = std::max(0, static_cast<int>(std::floor(bounds.left)) - 1);
  const int top = std::max(0, static_cast<int>(std::floor(bounds.top)) - 1);
  const int right = std::min(width, static_cast<int>(std::ceil(bounds.right)) + 1);
  const int bottom = std::min(height, static_cast<int>(std::ceil(bounds.bottom)) + 1);
  if (left >= right || top >= bottom) return {};
  return {left, top, right - left, bottom - top};
}

void measure(FlameShape& shape, std::span<const Point> model) {
  const Point left = model.front();
  const Point right = model.back();
  shape.base = {(left.x + right.x) / 2, (left.y + right.y) / 2};
  shape.area = area_of(model);
  for (const Point p : model) {
    shape.height = std::max(shape.height, std::hypot(p.x - shape.base.x, p.y - shape.base.y));
    shape.middle.x += p.x / static_cast<float>(model.size());
    shape.middle.y += p.y / static_cast<float>(model.size());
  }
}

void fill_thickness(FlameShape& shape, std::span<const Point> pixels, const Bounds& bounds, float unit) {
  const float finest = std::max(1.0F, unit / kCellsPerUnit);
  const float cell = std::max({finest, bounds.width() / kMostCells, bounds.height() / kMostCells});
  const int columns = static_cast<int>(std::ceil(bounds.width() / cell)) + 2;
  const int rows = static_cast<int>(std::ceil(bounds.height() / cell)) + 2;
  const float left = bounds.left - cell;
  const float top = bounds.top - cell;
  const Plane phi = solve_thickness(rasterised(pixels, left, top, cell, columns, rows));

  shape.thickness = Plane(shape.box.width, shape.box.height);
  const float units = cell / unit;
  for (const float value : phi.values) shape.thickest = std::max(shape.thickest, value);
  shape.thickest = units * std::sqrt(2 * shape.thickest);
  for (int y = 0; y < shape.box.height; ++y) {
    const float v = (static_cast<float>(shape.box.y + y) + 0.5F - top) / cell;
    for (int x = 0; x < shape.box.width; ++x) {
      if (shape.coverage.row(y)[x] == 0) continue;
      const float u = (static_cast<float>(shape.box.x + x) + 0.5F - left) / cell;
      shape.thickness.row(y)[x] = units * std::sqrt(2 * sampled(phi, u, v));
    }
  }
}

}  // namespace

FlameShape flame_shape(std::span<const Point> outline, const FlameScene& scene, float scale, float cap, int width,
                       int height) {
  FlameShape shape;
  std::vector<Point> points = finite_points(outline);
  if (points.size() < 3) return shape;
  for (Point& p : points) p = {scale * p.x, scale * p.y};
  measure(shape, points);
  constexpr float kLeastArea = 1e-5F;
  if (shape.area < kLeastArea) return shape;

  append_cap(points, cap);
  const float unit = scene.pixels_per_unit;
  shape.reach = unit * shape.height;
  const auto to_pixel = [&](Point p) { return Point{scene.base.x + unit * p.x, scene.base.y - unit * p.y}; };
  std::ranges::transform(points, points.begin(), to_pixel);
  shape.base = to_pixel(shape.base);
  shape.middle = to_pixel(shape.middle);
  const Bounds bounds = bounds_of(points);
  shape.box = visible_box(bounds, width, height);
  if (shape.empty()) return shape;
  shape.coverage = rasterised(points, static_cast<float>(shape.box.x), static_cast<float>(shape.box.y), 1,
                              shape.box.width, shape.box.height);
  fill_thickness(shape, points, bounds, unit);
  return shape;
}

}  // namespace wisp::drawing
