#include "wisp/draw/flame.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "draw/cairo.hpp"

namespace wisp {
namespace {

std::vector<Point> to_pixels(const Flame& flame) {
  std::vector<Point> points;
  for (const Point p : flame.outline) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) continue;
    points.push_back({flame.scene.base.x + flame.scene.pixels_per_unit * std::clamp(p.x, -8.0F, 8.0F),
                      flame.scene.base.y - flame.scene.pixels_per_unit * std::clamp(p.y, -8.0F, 8.0F)});
  }
  return points;
}

void draw_candle(cairo_t* context, const FlameScene& scene, const FlameStyle& style) {
  const double unit = scene.pixels_per_unit;
  const double width = style.candle_width * unit;
  const double top = scene.base.y + style.wick_gap * unit;
  const CairoPattern wax(cairo_pattern_create_linear(0, top, 0, top + width));
  cairo_pattern_add_color_stop_rgb(wax.get(), 0, 0.85, 0.6, 0.35);
  cairo_pattern_add_color_stop_rgb(wax.get(), 1, 0.2, 0.12, 0.07);
  cairo_set_source(context, wax.get());
  cairo_rectangle(context, scene.base.x - width / 2, top, width, style.candle_height * unit);
  cairo_fill(context);
  cairo_set_source_rgb(context, 0.1, 0.07, 0.05);
  cairo_set_line_width(context, 0.03 * unit);
  cairo_move_to(context, scene.base.x, top);
  cairo_line_to(context, scene.base.x, top - style.wick_height * unit);
  cairo_stroke(context);
}

}  // namespace

bool burns(const FlameScene& scene) { return scene.seconds_since_lit <= scene.seconds_since_out; }

void draw_flames(Image& image, std::span<const Flame> flames, const FlameStyle& style) {
  if (image.empty()) return;
  const CairoContext context = context_of(image);
  for (const Flame& flame : flames) {
    if (style.candle) draw_candle(context.get(), flame.scene, style);
  }
  for (const Flame& flame : flames) {
    const auto points = to_pixels(flame);
    if (points.size() < 3 || !burns(flame.scene)) continue;
    const double unit = flame.scene.pixels_per_unit;
    const double y = flame.scene.base.y - unit / 2;
    const CairoPattern halo(cairo_pattern_create_radial(flame.scene.base.x, y, 0, flame.scene.base.x, y, unit));
    cairo_pattern_add_color_stop_rgba(halo.get(), 0, 1, 0.6, 0.2, 0.35);
    cairo_pattern_add_color_stop_rgba(halo.get(), 1, 1, 0.6, 0.2, 0);
    cairo_set_source(context.get(), halo.get());
    cairo_paint(context.get());
    for (const Point p : points) cairo_line_to(context.get(), p.x, p.y);
    cairo_close_path(context.get());
    set_colour(context.get(), style.body);
    cairo_fill(context.get());
  }
}

void draw_flame(Image& image, std::span<const Point> outline, const FlameScene& scene, const FlameStyle& style) {
  const Flame flame{outline, scene};
  draw_flames(image, std::span(&flame, 1), style);
}

void draw_night(Image& image) {
  if (image.empty()) return;
  const CairoContext context = context_of(image);
  set_colour(context.get(), {8, 8, 12, 255});
  cairo_paint(context.get());
}

FlameScene framed(int width, int height) {
  FlameScene scene;
  scene.pixels_per_unit = std::min(static_cast<float>(height) * 0.36F, static_cast<float>(width) * 0.45F);
  scene.base = {static_cast<float>(width) / 2, static_cast<float>(height) * 0.76F};
  return scene;
}

}  // namespace wisp
