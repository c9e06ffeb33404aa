#include "wisp/draw/plot.hpp"

#include <cairo-svg.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "draw/cairo.hpp"
#include "draw/plot/plot_parts.hpp"
#include "wisp/base/file.hpp"

namespace wisp {

using namespace drawing;

namespace {

constexpr Colour kPaper{255, 255, 255};
constexpr double kSheetMargin = 8;
constexpr double kSheetTitle = 26;

// Options of a sheet, clamped to their ranges, and its size.
struct SheetLayout {
  int columns = 1;
  int rows = 1;
  double plot_width = 0;
  double plot_height = 0;
  double title = 0;
  double pixels_per_point = 1;

  double width() const { return columns * plot_width + 2 * kSheetMargin; }
  double height() const { return rows * plot_height + title + 2 * kSheetMargin; }
  int pixels(double points) const { return static_cast<int>(std::lround(points * pixels_per_point)); }
};

SheetLayout lay_out(const PlotSheet& sheet) {
  SheetLayout at;
  const int count = static_cast<int>(sheet.plots.size());
  at.columns = sheet.columns > 0 ? std::min(sheet.columns, count) : count;
  at.rows = (count + at.columns - 1) / at.columns;
  at.plot_width = std::clamp(sheet.plot_width, 80.0, 4000.0);
  at.plot_height = std::clamp(sheet.plot_height, 80.0, 4000.0);
  at.title = sheet.title.empty() ? 0 : kSheetTitle;
  at.pixels_per_point = std::clamp(sheet.pixels_per_point, 0.25, 8.0);
  return at;
}

void draw_plot(cairo_t* context, const Plot& plot, double width, double height, double left) {
  const Axes axes = make_axes(context, plot, width, height, left);
  draw_title(context, plot.title, axes.box);
  draw_grid(context, axes);
  cairo_save(context);
  cairo_rectangle(context, axes.box.left, axes.box.top - 1, axes.box.width(), axes.box.height() + 2);
  cairo_clip(context);
  for (std::size_t k = 0; k < plot.series.size(); ++k) {
    draw_series(context, plot.series[k], series_colour(plot.series[k], k), axes.x, axes.y);
  }
  cairo_restore(context);
  draw_axes(context, plot, axes);
  draw_marks(context, plot, axes);
  draw_keys(context, plot, axes);
}

// Returns the left edge of the data area, common to all plots of a column.
double left_of_column(cairo_t* context, const PlotSheet& sheet, const SheetLayout& at, std::size_t column) {
  double left = 0;
  for (std::size_t k = column; k < sheet.plots.size(); k += at.columns) {
    left = std::max(left, make_axes(context, sheet.plots[k], at.plot_width, at.plot_height).box.left);
  }
  return left;
}

void draw_sheet(cairo_t* context, const PlotSheet& sheet, const SheetLayout& at) {
  set_colour(context, kPaper);
  cairo_paint(context);
  if (!sheet.title.empty()) {
    show_text(context, sheet.title, kSheetMargin + 12, kSheetMargin + 17, {13.5, true}, {30, 30, 34});
  }
  std::vector<double> lefts;
  for (std::size_t column = 0; column < std::size_t(at.columns); ++column) {
    lefts.push_back(left_of_column(context, sheet, at, column));
  }
  for (std::size_t k = 0; k < sheet.plots.size(); ++k) {
    const std::size_t column = k % at.columns, row = k / at.columns;
    cairo_save(context);
    cairo_translate(context, kSheetMargin + static_cast<double>(column) * at.plot_width,
                    kSheetMargin + at.title + static_cast<double>(row) * at.plot_height);
    draw_plot(context, sheet.plots[k], at.plot_width, at.plot_height, lefts[column]);
    cairo_restore(context);
  }
}

// Cairo numbers SVG elements across the program's life; numbers from 1 in each file make equal plots equal bytes.
std::string with_own_numbers(const std::string& svg, std::string_view name) {
  std::string text;
  std::vector<std::string> seen;
  std::size_t from = 0;
  for (std::size_t at = svg.find(name); at != std::string::npos; at = svg.find(name, from)) {
    const std::size_t digits = at + name.size();
    const std::size_t end = std::min(svg.find_first_not_of("0123456789", digits), svg.size());
    text += svg.substr(from, digits - from);
    from = end;
    const std::string number = svg.substr(digits, end - digits);
    if (number.empty() || at == 0 || (svg[at - 1] != '"' && svg[at - 1] != '#')) {
      text += number;
      continue;
    }
    const auto place = std::ranges::find(seen, number);
    text += std::to_string(place - seen.begin() + 1);
    if (place == seen.end()) seen.push_back(number);
  }
  return text + svg.substr(from);
}

Result<void> write_svg(const std::filesystem::path& path, const PlotSheet& sheet, const SheetLayout& at) {
  std::string text;
  const CairoSurface surface(cairo_svg_surface_create_for_stream(append_bytes, &text, at.width(), at.height()));
  {
    const CairoContext context(cairo_create(surface.get()));
    draw_sheet(context.get(), sheet, at);
  }
  cairo_surface_finish(surface.get());
  const cairo_status_t status = cairo_surface_status(surface.get());
  if (status != CAIRO_STATUS_SUCCESS) {
    return Error{path.string() + ": cannot be drawn as SVG: " + cairo_status_to_string(status)};
  }
  return write_file(path, with_own_numbers(with_own_numbers(text, "surface"), "image"));
}

void widen(Plot& a, Plot& b, std::vector<double> PlotSeries::*values, PlotAxis Plot::*axis) {
  double low = 0, high = 0;
  for (const Plot* plot : {&a, &b}) {
    for (const PlotSeries& series : plot->series) {
      for (double value : series.*values) {
        if (!std::isfinite(value)) continue;
        low = std::min(low, value);
        high = std::max(high, value);
      }
    }
  }
  for (Plot* plot : {&a, &b}) {
    (plot->*axis).lowest = low;
    (plot->*axis).highest = high;
  }
}

}  // namespace

void share_axes(Plot& a, Plot& b) {
  widen(a, b, &PlotSeries::x, &Plot::x);
  widen(a, b, &PlotSeries::y, &Plot::y);
}

Image draw_plots(const PlotSheet& sheet) {
  assert(!sheet.plots.empty());
  const SheetLayout at = lay_out(sheet);
  Image image(std::clamp(at.pixels(at.width()), 1, kLargestImageSide),
              std::clamp(at.pixels(at.height()), 1, kLargestImageSide), kPaper);
  const CairoContext context = context_of(image);
  cairo_scale(context.get(), at.pixels_per_point, at.pixels_per_point);
  draw_sheet(context.get(), sheet, at);
  return image;
}

Result<void> write_plots(const std::filesystem::path& path, const PlotSheet& sheet) {
  if (sheet.plots.empty()) return Error{path.string() + ": there is nothing to plot"};
  const SheetLayout at = lay_out(sheet);
  if (path.extension() == ".svg") return write_svg(path, sheet, at);
  if (path.extension() != ".png") {
    return Error{path.string() + ": plots are written as PNG or SVG; name it .png or .svg"};
  }
  if (at.pixels(at.width()) > kLargestImageSide || at.pixels(at.height()) > kLargestImageSide) {
    return Error{path.string() + ": a picture of " + std::to_string(at.pixels(at.width())) + " x " +
                 std::to_string(at.pixels(at.height())) + " pixels is too large; show fewer plots in it"};
  }
  return write_png(path, draw_plots(sheet));
}

}  // namespace wisp
