// Shape of a flame in a picture: the pixels it covers, and the thickness of the glowing body behind each.
//
// The flame is a body of revolution. Where its half width is w, the chord of light at distance d from the edge is
// 2 √(d (2w − d)); and in a long strip φ = d (2w − d) / 2 solves ∇²φ = −1 with φ = 0 at the edge. So half the chord is
// √(2φ) with φ solved inside the outline, whatever its shape. It is smooth and moves as smoothly as the outline.

#include <algorithm>
#include <cmath>

#include "draw/cairo.hpp"
#include "draw/flame/flame_layers.hpp"

namespace wisp::drawing {
namespace {

// Limit of a flame's size in model units, which bounds memory for absurd outlines.
constexpr float kFarthest = 8;

// Resolution of the grid for φ: cells of about a hundredth of the flame, but not smaller than a pixel.
constexpr float kCellsPerUnit = 96;
constexpr int kMaxCells = 240;

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

// Junction of one side of the flame with its rounded base.
struct Shoulder {
  std::ptrdiff_t rest = 0;  // number of points at the outline's end that the base replaces
  Point at;
  Point way;  // unit vector along the side at the junction
};

// Follows the outline from one of its ends to its first rise through `height`, the shoulder. If no rise is within the
// first quarter of the points (a flame blown flat), the end itself is the shoulder.
template <class Points>
Shoulder shoulder_of(const Points& begin, std::ptrdiff_t size, float height) {
  Shoulder shoulder{0, begin[0], {0, -1}};
  std::ptrdiff_t above = 0;
  for (std::ptrdiff_t k = 1; k <= size / 4; ++k) {
    if (begin[k - 1].y >= height || begin[k].y < height) continue;
    const float part = (height - begin[k - 1].y) / (begin[k].y - begin[k - 1].y);
    shoulder.rest = k;
    shoulder.at = {begin[k - 1].x + part * (begin[k].x - begin[k - 1].x), height};
    above = k;
    break;
  }
  // The direction is averaged over a tenth of the outline to suppress wobbles.
  const Point from = begin[std::min(size - 1, above + std::max<std::ptrdiff_t>(1, size / 10))];
  const Point down{shoulder.at.x - from.x, shoulder.at.y - from.y};
  const float length = std::hypot(down.x, down.y);
  if (length > 0) shoulder.way = {down.x / length, down.y / length};
  return shoulder;
}

void append_curve(std::vector<Point>& points, Point p, Point q, Point r, Point s) {
  constexpr int kSteps = 14;
  for (int k = 1; k <= kSteps; ++k) {
    const float u = static_cast<float>(k) / kSteps;
    const float v = 1 - u;
    const float a = v * v * v, b = 3 * v * v * u, c = 3 * v * u * u, d = u * u * u;
    points.push_back({a * p.x + b * q.x + c * r.x + d * s.x, a * p.y + b * q.y + c * r.y + d * s.y});
  }
}

// Closes the outline below its shoulders by a drop around the wick: the visible part of a base is accidental, as the
// threshold cuts it off straight, or follows the wick upwards between two corners.
void close_base(std::vector<Point>& points, float cap) {
  float top = 0;
  for (const Point p : points) top = std::max(top, p.y);
  const float height = 0.17F * std::min(1.0F, top / 0.8F);
  const auto size = static_cast<std::ptrdiff_t>(points.size());
  const Shoulder left = shoulder_of(points.begin(), size, height);
  const Shoulder right = shoulder_of(points.rbegin(), size, height);
  points.erase(points.end() - right.rest, points.end());
  points.erase(points.begin(), points.begin() + left.rest);
  points.push_back(right.at);

  const Point lowest{0, -cap};
  const auto handle = [&](const Shoulder& side, float outwards) {
    const float reach = 0.5F * std::max(0.0F, side.at.y - lowest.y);
    // Limits the slope: strongly flaring sides would overhang the wick, and no side may turn upwards.
    const float across = outwards * std::min(0.6F, outwards * side.way.x);
    return Point{side.at.x + reach * across, side.at.y - reach * std::max(0.5F, -side.way.y)};
  };
  const float round = 0.28F * std::abs(right.at.x - left.at.x);
  append_curve(points, right.at, handle(right, 1), {lowest.x + round, lowest.y}, lowest);
  append_curve(points, lowest, {lowest.x - round, lowest.y}, handle(left, -1), left.at);
}

// Returns the share of each cell inside the polygon; the grid's origin is (left, top), a cell is `cell` pixels wide.
Plane rasterised(std::vector<Point> pixels, float left, float top, float cell, int columns, int rows) {
  for (Point& p : pixels) p = {(p.x - left) / cell, (p.y - top) / cell};
  return coverage_of(pixels, columns, rows, true);
}

// Solves ∇²φ = −1 with φ = 0 outside by red-black successive over-relaxation (Press et al., Numerical Recipes, section
// 20.5), in squared cells. The value of a partly covered cell is scaled by its covered share, so that φ moves with the
// edge and does not jump from cell to cell. The number of sweeps is fixed: enough for a body 40 cells wide.
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

// Returns the bilinear value of a grid with a border of one cell, at cell coordinates (cell centres at halves).
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

Point to_pixel(const FlameScene& scene, Point p) {
  return {scene.base.x + scene.pixels_per_unit * p.x, scene.base.y - scene.pixels_per_unit * p.y};
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

void fill_thickness(FlameShape& shape, const std::vector<Point>& pixels, const Bounds& bounds, float unit) {
  const float finest = std::max(1.0F, unit / kCellsPerUnit);
  const float cell = std::max({finest, bounds.width() / kMaxCells, bounds.height() / kMaxCells});
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

Plane coverage_of(std::span<const Point> polygon, int columns, int rows, bool fine) {
  const CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_A8, columns, rows));
  {
    const CairoContext context(cairo_create(surface.get()));
    if (fine) cairo_set_antialias(context.get(), CAIRO_ANTIALIAS_BEST);
    for (const Point p : polygon) cairo_line_to(context.get(), p.x, p.y);
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

PixelBox visible_box(const Bounds& bounds, int margin, int width, int height) {
  const int left = std::max(0, static_cast<int>(std::floor(bounds.left)) - margin);
  const int top = std::max(0, static_cast<int>(std::floor(bounds.top)) - margin);
  const int right = std::min(width, static_cast<int>(std::ceil(bounds.right)) + margin);
  const int bottom = std::min(height, static_cast<int>(std::ceil(bounds.bottom)) + margin);
  if (left >= right || top >= bottom) return {};
  return {left, top, right - left, bottom - top};
}

FlameShape flame_shape(std::span<const Point> outline, const FlameScene& scene, float scale, float cap, int width,
                       int height) {
  constexpr float kMinArea = 1e-5F;
  FlameShape shape;
  std::vector<Point> points = finite_points(outline);
  if (points.size() < 3) return shape;
  for (Point& p : points) p = {scale * p.x, scale * p.y};
  measure(shape, points);
  shape.reach = scene.pixels_per_unit * shape.height;
  shape.base = to_pixel(scene, shape.base);
  shape.middle = to_pixel(scene, shape.middle);
  if (shape.area < kMinArea) return shape;
  close_base(points, cap);
  std::ranges::transform(points, points.begin(), [&](Point p) { return to_pixel(scene, p); });
  const float unit = scene.pixels_per_unit;
  const Bounds bounds = bounds_of(points);
  shape.box = visible_box(bounds, 1, width, height);
  if (shape.empty()) return shape;
  shape.coverage = rasterised(points, static_cast<float>(shape.box.x), static_cast<float>(shape.box.y), 1,
                              shape.box.width, shape.box.height);
  fill_thickness(shape, points, bounds, unit);
  return shape;
}

}  // namespace wisp::drawing
