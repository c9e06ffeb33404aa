#include "wisp/draw/plot.hpp"

#include <cairo-svg.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "draw/cairo.hpp"
#include "wisp/base/file.hpp"

namespace wisp {
namespace {

constexpr std::array<Colour, 6> kPalette{
    {{31, 90, 166}, {214, 96, 20}, {30, 132, 90}, {150, 60, 150}, {90, 90, 90}, {190, 140, 0}}};

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void take(double v) {
    if (!std::isfinite(v)) return;
    low = std::min(low, v);
    high = std::max(high, v);
  }
};

void draw_one(cairo_t* context, const Plot& plot, double width, double height) {
  Range x, y;
  for (const PlotSeries& series : plot.series) {
    for (double v : series.x) x.take(v);
    for (double v : series.y) y.take(v);
  }
  if (!(x.low < x.high)) x = {0, 1};
  if (!(y.low < y.high)) y = {y.low - 1, y.low + 1};
  const double left = 50, top = 30, right = width - 10, bottom = height - 40;
  const auto px = [&](double v) { return left + (v - x.low) / (x.high - x.low) * (right - left); };
  const auto py = [&](double v) { return bottom - (v - y.low) / (y.high - y.low) * (bottom - top); };
  set_colour(context, {60, 60, 60});
  cairo_set_line_width(context, 0.8);
  cairo_rectangle(context, left, top, right - left, bottom - top);
  cairo_stroke(context);
  for (std::size_t k = 0; k < plot.series.size(); ++k) {
    const PlotSeries& series = plot.series[k];
    set_colour(context, series.colour.value_or(kPalette[k % kPalette.size()]));
    cairo_set_line_width(context, series.width);
    for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
      if (std::isfinite(series.y[i])) cairo_line_to(context, px(series.x[i]), py(series.y[i]));
    }
    cairo_stroke(context);
  }
  cairo_select_font_face(context, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context, 11);
  set_colour(context, {40, 40, 40});
  cairo_move_to(context, left, top - 8);
  cairo_show_text(context, plot.title.c_str());
}

void draw_sheet(cairo_t* context, const PlotSheet& sheet, int columns) {
  set_colour(context, {255, 255, 255});
  cairo_paint(context);
  for (std::size_t k = 0; k < sheet.plots.size(); ++k) {
    cairo_save(context);
    cairo_translate(context, static_cast<double>(k % columns) * sheet.plot_width,
                    static_cast<double>(k / columns) * sheet.plot_height);
    draw_one(context, sheet.plots[k], sheet.plot_width, sheet.plot_height);
    cairo_restore(context);
  }
}

int columns_of(const PlotSheet& sheet) {
  return sheet.columns > 0 ? sheet.columns : static_cast<int>(sheet.plots.size());
}

int rows_of(const PlotSheet& sheet) {
  return (static_cast<int>(sheet.plots.size()) + columns_of(sheet) - 1) / columns_of(sheet);
}

cairo_status_t append(void* closure, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

Image draw_plots(const PlotSheet& sheet) {
  assert(!sheet.plots.empty());
  Image image(static_cast<int>(sheet.plot_width * columns_of(sheet) * sheet.pixels_per_point),
              static_cast<int>(sheet.plot_height * rows_of(sheet) * sheet.pixels_per_point), {255, 255, 255, 255});
  const CairoContext context = context_of(image);
  cairo_scale(context.get(), sheet.pixels_per_point, sheet.pixels_per_point);
  draw_sheet(context.get(), sheet, columns_of(sheet));
  return image;
}

Result<void> write_plots(const std::filesystem::path& path, const PlotSheet& sheet) {
  if (sheet.plots.empty()) return Error{path.string() + ": there is nothing to plot"};
  if (path.extension() == ".png") return write_png(path, draw_plots(sheet));
  if (path.extension() != ".svg") return Error{path.string() + ": plots are written as .png or .svg"};
  std::string text;
  const CairoSurface surface(cairo_svg_surface_create_for_stream(append, &text, sheet.plot_width * columns_of(sheet),
                                                                 sheet.plot_height * rows_of(sheet)));
  {
    const CairoContext context(cairo_create(surface.get()));
    draw_sheet(context.get(), sheet, columns_of(sheet));
  }
  cairo_surface_finish(surface.get());
  return write_file(path, text);
}

}  // namespace wisp
