#include "draw/plot/plot_parts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "draw/cairo.hpp"

namespace wisp::drawing {
namespace {

constexpr Colour kInk{30, 30, 34};
constexpr Colour kLabel{62, 63, 68};
constexpr Colour kTick{92, 93, 99};
constexpr Colour kAxis{120, 121, 128};
constexpr Colour kGrid{233, 233, 237};
constexpr Colour kMark{192, 38, 45};

constexpr Font kTitleFont{11, true};
constexpr Font kLabelFont{9.5};
constexpr Font kTickFont{8.5};
constexpr Font kNoteFont{8.5};

constexpr double kTickLength = 3;
constexpr double kTitleRoom = 22;
constexpr double kLegendLine = 15;
constexpr double kLegendSample = 20;

struct Range {
  double low = 0;
  double high = 1;
};

void take_series(const PlotSeries& series, const Plot& plot, Extent& x, Extent& y) {
  const double reach = series.shape == SeriesShape::kBars ? bar_width(series) / 2 : 0;
  for (std::size_t k = 0; k < std::min(series.x.size(), series.y.size()); ++k) {
    if (!std::isfinite(series.y[k])) continue;
    x.take(series.x[k] - reach, plot.x.logarithmic);
    x.take(series.x[k] + reach, plot.x.logarithmic);
    y.take(series.y[k], plot.y.logarithmic);
  }
  for (const std::vector<double>* ends : {&series.low, &series.high}) {
    for (const double end : *ends) y.take(end, plot.y.logarithmic);
  }
  if (series.shape == SeriesShape::kBars) y.take(0, plot.y.logarithmic);
}

// Returns the data's range, widened by the share `air` at both ends; with `to_zero`, a low end near zero becomes zero.
Range with_air(const Extent& extent, bool logarithmic, double air, bool to_zero) {
  if (extent.empty()) return logarithmic ? Range{1, 10} : Range{0, 1};
  if (logarithmic) {
    const double factor = extent.low() == extent.high() ? 2 : std::pow(extent.high() / extent.low(), air);
    return {extent.low() / factor, extent.high() * factor};
  }
  Range range{extent.low(), extent.high()};
  const double length = range.high - range.low;
  if (length <= 1e-12 * std::max(std::abs(range.low), std::abs(range.high))) {
    const double half = range.low == 0 ? 1 : 0.5 * std::abs(range.low);
    return {range.low - half, range.high + half};
  }
  // Near zero: below 0.3 of the highest value.
  if (to_zero && range.low >= 0 && range.low < 0.3 * range.high)
    range.low = 0;
  else
    range.low -= air * length;
  range.high += air * length;
  return range;
}

Range fixed_ends(Range range, const PlotAxis& axis) {
  const auto valid = [&](double end) { return std::isfinite(end) && (!axis.logarithmic || end > 0); };
  if (axis.lowest && valid(*axis.lowest)) range.low = *axis.lowest;
  if (axis.highest && valid(*axis.highest)) range.high = *axis.highest;
  if (range.low < range.high) return range;
  // If the requested ends leave an empty range, the lower end is kept.
  return {range.low, axis.logarithmic ? range.low * 10 : range.low + 1};
}

bool has_points(const Plot& plot) {
  return std::ranges::any_of(plot.series, [](const PlotSeries& series) {
    return series.shape == SeriesShape::kPoints || series.marker != Marker::kNone;
  });
}

void make_equal(Axes& axes) {
  const double x_unit = (axes.x.high - axes.x.low) / axes.box.width();
  const double y_unit = (axes.y.high - axes.y.low) / axes.box.height();
  Scale& scale = x_unit < y_unit ? axes.x : axes.y;
  const double length = std::max(x_unit, y_unit) * (x_unit < y_unit ? axes.box.width() : axes.box.height());
  const double middle = (scale.low + scale.high) / 2;
  scale.low = middle - length / 2;
  scale.high = middle + length / 2;
}

struct SeriesKey {
  const PlotSeries* series;
  Colour colour;
};

std::vector<SeriesKey> legend_entries(const Plot& plot) {
  std::vector<SeriesKey> entries;
  for (std::size_t k = 0; k < plot.series.size(); ++k) {
    if (!plot.series[k].label.empty()) entries.push_back({&plot.series[k], series_colour(plot.series[k], k)});
  }
  return entries;
}

double entry_width(cairo_t* context, const SeriesKey& entry) {
  return kLegendSample + 5 + text_width(context, entry.series->label, kNoteFont) + 14;
}

int legend_lines(cairo_t* context, const Plot& plot, double room) {
  int lines = 0;
  double used = room;
  for (const SeriesKey& entry : legend_entries(plot)) {
    const double width = entry_width(context, entry);
    if (used + width > room) {
      ++lines;
      used = 0;
    }
    used += width;
  }
  return lines;
}

double widest(cairo_t* context, const Ticks& ticks) {
  double width = 0;
  for (const std::string& label : ticks.labels) width = std::max(width, text_width(context, label, kTickFont));
  return width;
}

// Rounds to half points, which keeps one-point lines sharp in the PNG.
double crisp(double value) { return std::round(value * 2) / 2; }

}  // namespace

Axes make_axes(cairo_t* context, const Plot& plot, double width, double height, double left) {
  Extent x_extent, y_extent;
  for (const PlotSeries& series : plot.series) take_series(series, plot, x_extent, y_extent);
  for (const PlotMark& mark : plot.marks) {
    if (mark.vertical)
      x_extent.take(mark.at, plot.x.logarithmic);
    else
      y_extent.take(mark.at, plot.y.logarithmic);
  }
  const double x_air = has_points(plot) ? 0.05 : 0;
  const Range x = fixed_ends(with_air(x_extent, plot.x.logarithmic, x_air, false), plot.x);
  const Range y = fixed_ends(with_air(y_extent, plot.y.logarithmic, 0.06, !plot.equal_units), plot.y);

  Axes axes;
  axes.box.right = width - 14;
  axes.box.bottom = height - (plot.x.label.empty() ? 24 : 40);
  axes.box.top = (plot.title.empty() ? 8 : kTitleRoom) + 8 + kLegendLine * legend_lines(context, plot, width - 60);
  axes.x = {x.low, x.high, 0, 0, plot.x.logarithmic};
  axes.y = {y.low, y.high, 0, 0, plot.y.logarithmic};
  const double label_room = plot.y.label.empty() ? 6 : 22;
  const auto y_ticks = [&] {
    const double room = plot.y.logarithmic ? 22 : 36;
    return make_ticks(axes.y, static_cast<int>(axes.box.height() / room), plot.y.whole_numbers);
  };
  axes.y_ticks = y_ticks();
  if (!axes.y_ticks.shared.empty()) axes.box.top += 10;
  axes.box.left = std::max(left, crisp(label_room + widest(context, axes.y_ticks) + kTickLength + 6));
  axes.box.bottom = crisp(axes.box.bottom);
  if (plot.equal_units && !plot.x.logarithmic && !plot.y.logarithmic) {
    make_equal(axes);
    axes.y_ticks = y_ticks();
  }
  axes.x_ticks = make_ticks(axes.x, static_cast<int>(axes.box.width() / 58), plot.x.whole_numbers);
  axes.x.from = axes.box.left;
  axes.x.to = axes.box.right;
  axes.y.from = axes.box.bottom;
  axes.y.to = axes.box.top;
  return axes;
}

void draw_title(cairo_t* context, const std::string& title, const PlotBox& box) {
  if (title.empty()) return;
  show_text(context, title, box.left, 18, kTitleFont, kInk);
}

void draw_grid(cairo_t* context, const Axes& axes) {
  cairo_set_dash(context, nullptr, 0, 0);
  cairo_set_line_width(context, 0.7);
  set_colour(context, kGrid);
  for (const double value : axes.y_ticks.at) {
    const double y = crisp(axes.y(value));
    cairo_move_to(context, axes.box.left, y);
    cairo_line_to(context, axes.box.right, y);
  }
  cairo_stroke(context);
}

void draw_axes(cairo_t* context, const Plot& plot, const Axes& axes) {
  const PlotBox& box = axes.box;
  cairo_set_dash(context, nullptr, 0, 0);
  cairo_set_line_cap(context, CAIRO_LINE_CAP_SQUARE);
  cairo_set_line_width(context, 0.8);
  set_colour(context, kAxis);
  cairo_move_to(context, box.left, box.top);
  cairo_line_to(context, box.left, box.bottom);
  cairo_line_to(context, box.right, box.bottom);
  const auto tick_x = [&](double value, double length) {
    const double x = crisp(axes.x(value));
    cairo_move_to(context, x, box.bottom);
    cairo_line_to(context, x, box.bottom + length);
  };
  const auto tick_y = [&](double value, double length) {
    const double y = crisp(axes.y(value));
    cairo_move_to(context, box.left, y);
    cairo_line_to(context, box.left - length, y);
  };
  for (const double value : axes.x_ticks.at) tick_x(value, kTickLength);
  for (const double value : axes.x_ticks.between) tick_x(value, kTickLength / 2);
  for (const double value : axes.y_ticks.at) tick_y(value, kTickLength);
  for (const double value : axes.y_ticks.between) tick_y(value, kTickLength / 2);
  cairo_stroke(context);

  for (std::size_t k = 0; k < axes.x_ticks.at.size(); ++k) {
    show_text(context, axes.x_ticks.labels[k], axes.x(axes.x_ticks.at[k]), box.bottom + 13, kTickFont, kTick,
              Align::kCentre);
  }
  for (std::size_t k = 0; k < axes.y_ticks.at.size(); ++k) {
    show_text(context, axes.y_ticks.labels[k], box.left - kTickLength - 3, axes.y(axes.y_ticks.at[k]) + 3, kTickFont,
              kTick, Align::kRight);
  }
  show_text(context, axes.y_ticks.shared, box.left, box.top - 5, kTickFont, kTick, Align::kCentre);
  show_text(context, axes.x_ticks.shared, box.right, box.bottom + 26, kTickFont, kTick, Align::kRight);
  show_text(context, plot.x.label, (box.left + box.right) / 2, box.bottom + 30, kLabelFont, kLabel, Align::kCentre);
  cairo_save(context);
  cairo_translate(context, 14, (box.top + box.bottom) / 2);
  cairo_rotate(context, -std::numbers::pi / 2);
  show_text(context, plot.y.label, 0, 0, kLabelFont, kLabel, Align::kCentre);
  cairo_restore(context);
}

void draw_marks(cairo_t* context, const Plot& plot, const Axes& axes) {
  const PlotBox& box = axes.box;
  for (const PlotMark& mark : plot.marks) {
    const Scale& scale = mark.vertical ? axes.x : axes.y;
    if (!scale.shows(mark.at) || mark.at < scale.low || mark.at > scale.high) continue;
    const Colour colour = mark.colour.value_or(kMark);
    const double at = crisp(scale(mark.at));
    cairo_move_to(context, mark.vertical ? at : box.left, mark.vertical ? box.top : at);
    cairo_line_to(context, mark.vertical ? at : box.right, mark.vertical ? box.bottom : at);
    cairo_set_line_width(context, 1.1);
    set_dash(context, mark.dash, 1.1);
    set_colour(context, colour);
    cairo_stroke(context);
    if (!mark.vertical) {
      show_text(context, mark.label, box.right - 2, at - 4, kNoteFont, colour, Align::kRight);
      continue;
    }
    const bool room = at + 6 + text_width(context, mark.label, kNoteFont) < box.right;
    show_text(context, mark.label, room ? at + 5 : at - 5, box.top + 9, kNoteFont, colour,
              room ? Align::kLeft : Align::kRight);
  }
}

void draw_keys(cairo_t* context, const Plot& plot, const Axes& axes) {
  const double room = axes.box.right + 14 - 60;
  double x = axes.box.left;
  double y = (plot.title.empty() ? 8 : kTitleRoom) + kLegendLine / 2;
  for (const SeriesKey& entry : legend_entries(plot)) {
    const double width = entry_width(context, entry);
    if (x > axes.box.left && x + width - axes.box.left > room) {
      x = axes.box.left;
      y += kLegendLine;
    }
    draw_sample(context, *entry.series, entry.colour, x, y, kLegendSample);
    show_text(context, entry.series->label, x + kLegendSample + 5, y + 3, kNoteFont, kLabel);
    x += width;
  }
}

}  // namespace wisp::drawing
