#include "wisp/draw/overlay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "draw/cairo.hpp"

namespace wisp {

using namespace drawing;

namespace {

constexpr Colour kCasing{0, 0, 0, 170};
constexpr Colour kPlate{8, 8, 10, 165};
constexpr Colour kText{244, 240, 232, 255};

// Limit of coordinates: Cairo stores them in 24.8 fixed point, and larger ones are outside the picture.
constexpr float kFarthest = 1e5F;

void trace(cairo_t* context, std::span<const Point> points, bool closed) {
  cairo_new_path(context);
  bool whole = !points.empty();
  for (const Point p : points) {
    if (std::isfinite(p.x) && std::isfinite(p.y)) {
      cairo_line_to(context, std::clamp(p.x, -kFarthest, kFarthest), std::clamp(p.y, -kFarthest, kFarthest));
    } else {
      cairo_new_sub_path(context);
      whole = false;
    }
  }
  if (closed && whole) cairo_close_path(context);
}

// Returns the requested width or, for 0, 1/300 of the picture's height: visible across a room without hiding much.
double line_width(const Image& image, float asked) {
  if (asked > 0) return std::clamp(asked, 0.25F, 50.0F);
  return std::clamp(image.height() / 300.0, 1.2, 6.0);
}

void stroke(cairo_t* context, const LineStyle& style, double width) {
  const double casing = std::clamp(style.casing, 0.0F, 20.0F);
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
  cairo_set_line_cap(context, style.dashed ? CAIRO_LINE_CAP_BUTT : CAIRO_LINE_CAP_ROUND);
  if (casing > 0) {
    set_colour(context, kCasing);
    cairo_set_line_width(context, width + 2 * casing);
    cairo_stroke_preserve(context);
  }
  if (style.dashed) {
    const std::array<double, 2> dashes{width * 3.5, width * 2.2};
    cairo_set_dash(context, dashes.data(), dashes.size(), 0);
  }
  set_colour(context, style.colour);
  cairo_set_line_width(context, width);
  cairo_stroke(context);
  cairo_set_dash(context, nullptr, 0, 0);
}

void rounded_box(cairo_t* context, double x, double y, double width, double height, double radius) {
  cairo_new_sub_path(context);
  cairo_arc(context, x + width - radius, y + radius, radius, -std::numbers::pi / 2, 0);
  cairo_arc(context, x + width - radius, y + height - radius, radius, 0, std::numbers::pi / 2);
  cairo_arc(context, x + radius, y + height - radius, radius, std::numbers::pi / 2, std::numbers::pi);
  cairo_arc(context, x + radius, y + radius, radius, std::numbers::pi, 3 * std::numbers::pi / 2);
  cairo_close_path(context);
}

// Returns the requested text size or, for 0, 1/36 of the picture's height: legible without hiding much.
double text_size(const Image& image, float asked) {
  if (asked > 0) return asked;
  return std::clamp(image.height() / 36.0, 9.0, 40.0);
}

struct Plate {
  double x = 0;
  double y = 0;
};

// Draws the plate in its corner. Returns the position of its content.
Plate draw_plate(cairo_t* context, const Image& image, Corner corner, double width, double height, double pad) {
  const bool right = corner == Corner::kTopRight || corner == Corner::kBottomRight;
  const bool bottom = corner == Corner::kBottomLeft || corner == Corner::kBottomRight;
  const double margin = pad;
  const double x = right ? image.width() - margin - width - 2 * pad : margin;
  const double y = bottom ? image.height() - margin - height - 2 * pad : margin;
  rounded_box(context, std::round(x), std::round(y), std::round(width + 2 * pad), std::round(height + 2 * pad),
              pad * 0.6);
  set_colour(context, kPlate);
  cairo_fill(context);
  return {std::round(x) + pad, std::round(y) + pad};
}

}  // namespace

void draw_outline(Image& image, std::span<const Point> outline, const LineStyle& style) {
  if (image.empty() || outline.empty()) return;
  const CairoContext context = context_of(image);
  trace(context.get(), outline, style.closed);
  stroke(context.get(), style, line_width(image, style.width));
}

void draw_legend(Image& image, std::span<const LegendEntry> entries, Corner corner, float text_height) {
  if (image.empty() || entries.empty()) return;
  const CairoContext context = context_of(image);
  const double size = text_size(image, text_height);
  double widest = 0;
  for (const LegendEntry& entry : entries) widest = std::max(widest, text_width(context.get(), entry.text, {size}));
  const double sample = size * 1.9;
  const double line = size * 1.45;
  const Plate plate = draw_plate(context.get(), image, corner, sample + size * 0.6 + widest,
                                 line * static_cast<double>(entries.size()), size * 0.6);
  double middle = plate.y + line / 2;
  for (const LegendEntry& entry : entries) {
    // Centres the line on a row of pixels, where even a thin line has its full colour.
    const double row = std::floor(middle) + 0.5;
    cairo_new_path(context.get());
    cairo_move_to(context.get(), plate.x, row);
    cairo_line_to(context.get(), plate.x + sample, row);
    stroke(context.get(), entry.style, line_width(image, entry.style.width));
    show_text(context.get(), entry.text, plate.x + sample + size * 0.6, middle + size * 0.36, {size}, kText);
    middle += line;
  }
}

void draw_label(Image& image, std::string_view text, Corner corner, float text_height) {
  if (image.empty() || text.empty()) return;
  const CairoContext context = context_of(image);
  const double size = text_size(image, text_height);
  const Plate plate =
      draw_plate(context.get(), image, corner, text_width(context.get(), text, {size}), size * 1.1, size * 0.5);
  show_text(context.get(), text, plate.x, plate.y + size * 0.91, {size}, kText);
}

void draw_note(Image& image, std::span<const std::string> lines, Corner corner, float text_height, float opacity) {
  if (image.empty() || lines.empty() || !(opacity > 0)) return;
  const CairoContext context = context_of(image);
  const double size = text_size(image, text_height);
  double first = 0, rest = 0;
  const auto halves = [](const std::string& line) {
    const std::size_t tab = line.find('\t');
    if (tab == std::string::npos) return std::pair<std::string, std::string>{"", line};
    return std::pair{line.substr(0, tab), line.substr(tab + 1)};
  };
  for (const std::string& line : lines) {
    const auto [before, after] = halves(line);
    if (!before.empty()) first = std::max(first, text_width(context.get(), before, {size, true}) + size);
    rest = std::max(rest, text_width(context.get(), after, {size}));
  }
  cairo_push_group(context.get());
  const double line_height = size * 1.5;
  const Plate plate = draw_plate(context.get(), image, corner, first + rest,
                                 line_height * static_cast<double>(lines.size()) - 0.4 * size, size * 0.7);
  double y = plate.y + size * 0.91;
  for (const std::string& line : lines) {
    const auto [before, after] = halves(line);
    show_text(context.get(), before, plate.x, y, {size, true}, kText);
    show_text(context.get(), after, plate.x + (before.empty() ? 0 : first), y, {size}, kText);
    y += line_height;
  }
  cairo_pop_group_to_source(context.get());
  cairo_paint_with_alpha(context.get(), std::min(1.0, static_cast<double>(opacity)));
}

}  // namespace wisp
