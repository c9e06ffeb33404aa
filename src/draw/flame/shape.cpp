// Outlines that are no flames: filled shapes on a plain ground.

#include <algorithm>
#include <cmath>
#include <vector>

#include "draw/cairo.hpp"
#include "wisp/draw/flame.hpp"
#include "wisp/draw/overlay.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

using namespace drawing;

namespace {

constexpr Colour kGround{38, 41, 46, 255};
constexpr Colour kShape{176, 184, 192, 255};
constexpr Colour kEdge{236, 240, 244, 255};
constexpr float kNarrower = 0.8F;  // of its width at two fifths of its height, near its tip

// The control polygon in the middle of its range, in the model's units.
std::vector<Point> middle_polygon(const Model& model) {
  std::vector<Point> out;
  const auto middle = [](const Output& output) { return static_cast<float>(0.5 * (output.lowest + output.highest)); };
  for (std::size_t k = 0; k + 1 < model.outputs.size(); k += 2) {
    out.push_back({middle(model.outputs[k]), middle(model.outputs[k + 1])});
  }
  return out;
}

float width_at(const std::vector<Point>& outline, float height) {
  float low = 1e30F, high = -1e30F;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Point a = outline[k], b = outline[(k + 1) % outline.size()];
    if ((a.y > height) == (b.y > height)) continue;
    const float x = a.x + (height - a.y) / (b.y - a.y) * (b.x - a.x);
    low = std::min(low, x);
    high = std::max(high, x);
  }
  return std::max(0.0F, high - low);
}

void fill(Image& image, const std::vector<Point>& pixels) {
  const CairoContext context = context_of(image);
  cairo_move_to(context.get(), pixels.front().x, pixels.front().y);
  for (const Point p : pixels) cairo_line_to(context.get(), p.x, p.y);
  cairo_close_path(context.get());
  set_colour(context.get(), kShape);
  cairo_fill(context.get());
}

}  // namespace

bool is_flame(const Model& model) {
  if (!std::holds_alternative<OutlineView>(model.view) || model.outputs.empty()) return false;
  if (model.extinction) return true;
  const std::vector<Point> outline = middle_polygon(model);
  const auto farther = [](Point a, Point b) { return std::hypot(a.x, a.y) < std::hypot(b.x, b.y); };
  const Point tip = *std::max_element(outline.begin(), outline.end(), farther);
  const bool stands = tip.y > std::abs(tip.x) && outline.front().x < outline.back().x;
  return stands && width_at(outline, 0.88F * tip.y) < kNarrower * width_at(outline, 0.4F * tip.y);
}

void draw_shapes(Image& image, std::span<const Flame> shapes) {
  {
    const CairoContext context = context_of(image);
    set_colour(context.get(), kGround);
    cairo_paint(context.get());
  }
  for (const Flame& shape : shapes) {
    std::vector<Point> pixels;
    for (const Point p : shape.outline) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) continue;
      pixels.push_back({shape.scene.base.x + p.x * shape.scene.pixels_per_unit,
                        shape.scene.base.y - p.y * shape.scene.pixels_per_unit});
    }
    if (pixels.size() < 3) continue;
    fill(image, pixels);
    draw_outline(image, pixels, {.colour = kEdge, .casing = 0});
  }
}

}  // namespace wisp
