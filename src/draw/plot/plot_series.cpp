#include "draw/plot/plot_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "draw/cairo.hpp"

namespace wisp::drawing {
namespace {

// Colours differ in lightness as well as in hue, for gray printers and colour-blind readers.
constexpr std::array<Colour, 6> kPalette{
    {{31, 90, 166}, {217, 96, 26}, {42, 140, 90}, {142, 69, 133}, {184, 134, 11}, {90, 91, 96}}};

// Samples per point of width above which a line is drawn as its envelope.
constexpr double kDensest = 6;
constexpr double kEnvelopeColumn = 0.5;  // points

std::size_t size_of(const PlotSeries& series) { return std::min(series.x.size(), series.y.size()); }

bool shown(const PlotSeries& series, std::size_t k, const Scale& x, const Scale& y) {
  return x.shows(series.x[k]) && y.shows(series.y[k]);
}

void mark(cairo_t* context, Marker marker, double x, double y, double size, Colour colour) {
  if (marker == Marker::kNone) return;
  const double half = size / 2;
  cairo_new_path(context);
  cairo_arc(context, x, y, half, 0, 2 * std::numbers::pi);
  if (marker == Marker::kRing) {
    set_colour(context, {255, 255, 255});
    cairo_fill_preserve(context);
    set_colour(context, colour);
    cairo_set_line_width(context, std::max(0.8, size / 4));
    cairo_stroke(context);
    return;
  }
  set_colour(context, colour);
  cairo_fill(context);
}

bool dense(const PlotSeries& series, const Scale& x) {
  const double width = std::abs(x.to - x.from);
  return static_cast<double>(size_of(series)) > kDensest * width && std::is_sorted(series.x.begin(), series.x.end());
}

// Draws each narrow column's first, lowest, highest and last sample: to the eye the same picture, in a smaller file.
void trace_envelope(cairo_t* context, const PlotSeries& series, const Scale& x, const Scale& y) {
  const std::size_t size = size_of(series);
  for (std::size_t k = 0; k < size;) {
    if (!shown(series, k, x, y)) {
      cairo_new_sub_path(context);
      ++k;
      continue;
    }
    const double column = std::floor(x(series.x[k]) / kEnvelopeColumn);
    const double first = y(series.y[k]);
    double lowest = first, highest = first, last = first;
    for (; k < size && shown(series, k, x, y) && std::floor(x(series.x[k]) / kEnvelopeColumn) == column; ++k) {
      last = y(series.y[k]);
      lowest = std::min(lowest, last);
      highest = std::max(highest, last);
    }
    const double at = (column + 0.5) * kEnvelopeColumn;
    for (const double height : {first, lowest, highest, last}) cairo_line_to(context, at, height);
  }
}

void draw_line(cairo_t* context, const PlotSeries& series, Colour colour, const Scale& x, const Scale& y) {
  cairo_set_line_width(context, std::clamp(series.width, 0.1, 20.0));
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
  set_dash(context, series.dash, series.width);
  cairo_new_path(context);
  const bool envelope = dense(series, x);
  if (envelope) trace_envelope(context, series, x, y);
  for (std::size_t k = 0; !envelope && k < size_of(series); ++k) {
    if (shown(series, k, x, y))
      cairo_line_to(context, x(series.x[k]), y(series.y[k]));
    else
      cairo_new_sub_path(context);
  }
  set_colour(context, colour);
  cairo_stroke(context);
}

void draw_bars(cairo_t* context, const PlotSeries& series, Colour colour, const Scale& x, const Scale& y) {
  const double half = bar_width(series) / 2;
  const double floor = y.logarithmic ? y.from : y(0);
  // All bars are one path, so that touching neighbours show no seam.
  for (std::size_t k = 0; k < size_of(series); ++k) {
    if (!shown(series, k, x, y)) continue;
    const double left = x(series.x[k] - half);
    const double top = y(series.y[k]);
    cairo_rectangle(context, left, std::min(top, floor), x(series.x[k] + half) - left, std::abs(floor - top));
  }
  set_colour(context, colour);
  cairo_fill(context);
}

std::size_t interval_size(const PlotSeries& series) {
  return std::min({series.x.size(), series.low.size(), series.high.size()});
}

void draw_band(cairo_t* context, const PlotSeries& series, Colour colour, const Scale& x, const Scale& y) {
  const std::size_t size = interval_size(series);
  const auto whole = [&](std::size_t k) {
    return x.shows(series.x[k]) && y.shows(series.low[k]) && y.shows(series.high[k]);
  };
  colour.opacity = static_cast<std::uint8_t>(colour.opacity / 5);
  set_colour(context, colour);
  for (std::size_t begin = 0; begin < size;) {
    if (!whole(begin)) {
      ++begin;
      continue;
    }
    std::size_t end = begin;
    while (end < size && whole(end)) ++end;
    for (std::size_t k = begin; k < end; ++k) cairo_line_to(context, x(series.x[k]), y(series.high[k]));
    for (std::size_t k = end; k-- > begin;) cairo_line_to(context, x(series.x[k]), y(series.low[k]));
    cairo_close_path(context);
    cairo_fill(context);
    begin = end;
  }
}

void draw_interval_bars(cairo_t* context, const PlotSeries& series, Colour colour, const Scale& x, const Scale& y) {
  constexpr double kCap = 2.6;
  cairo_set_dash(context, nullptr, 0, 0);
  cairo_set_line_width(context, 0.9);
  for (std::size_t k = 0; k < interval_size(series); ++k) {
    if (!x.shows(series.x[k]) || !y.shows(series.low[k]) || !y.shows(series.high[k])) continue;
    const double at = x(series.x[k]);
    const double low = y(series.low[k]);
    const double high = y(series.high[k]);
    cairo_move_to(context, at, low);
    cairo_line_to(context, at, high);
    for (const double end : {low, high}) {
      cairo_move_to(context, at - kCap, end);
      cairo_line_to(context, at + kCap, end);
    }
    set_colour(context, colour);
    cairo_stroke(context);
  }
}

}  // namespace

Colour series_colour(const PlotSeries& series, std::size_t place) {
  return series.colour.value_or(kPalette[place % kPalette.size()]);
}

void set_dash(cairo_t* context, Dash dash, double width) {
  const std::array<double, 2> dashed{2.5 + 2 * width, 1.5 + 1.2 * width};
  const std::array<double, 2> dotted{0.01, 1.2 + 1.4 * width};
  if (dash == Dash::kDashed)
    cairo_set_dash(context, dashed.data(), dashed.size(), 0);
  else if (dash == Dash::kDotted)
    cairo_set_dash(context, dotted.data(), dotted.size(), 0);
  else
    cairo_set_dash(context, nullptr, 0, 0);
  cairo_set_line_cap(context, dash == Dash::kDotted ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
}

double bar_width(const PlotSeries& series) {
  double width = 0;
  for (std::size_t k = 1; k < size_of(series); ++k) {
    const double step = std::abs(series.x[k] - series.x[k - 1]);
    if (step > 0 && std::isfinite(step) && (width == 0 || step < width)) width = step;
  }
  return width > 0 ? width : 1;
}

void draw_series(cairo_t* context, const PlotSeries& series, Colour colour, const Scale& x, const Scale& y) {
  if (series.interval == IntervalShape::kBand) draw_band(context, series, colour, x, y);
  if (series.shape == SeriesShape::kBars) draw_bars(context, series, colour, x, y);
  if (series.shape == SeriesShape::kLine) draw_line(context, series, colour, x, y);
  if (series.interval == IntervalShape::kBars) draw_interval_bars(context, series, colour, x, y);
  const bool points = series.shape == SeriesShape::kPoints;
  const Marker marker = points && series.marker == Marker::kNone ? Marker::kDot : series.marker;
  if (marker == Marker::kNone) return;
  const double size = std::clamp(series.marker_size, 0.5, 50.0);
  for (std::size_t k = 0; k < size_of(series); ++k) {
    if (!shown(series, k, x, y)) continue;
    mark(context, marker, x(series.x[k]), y(series.y[k]), size, colour);
  }
}

void draw_sample(cairo_t* context, const PlotSeries& series, Colour colour, double x, double y, double width) {
  cairo_new_path(context);
  if (series.shape == SeriesShape::kBars) {
    cairo_rectangle(context, x + width * 0.2, y - 3.5, width * 0.6, 7);
    set_colour(context, colour);
    cairo_fill(context);
    return;
  }
  const bool points = series.shape == SeriesShape::kPoints;
  if (!points) {
    cairo_set_line_width(context, std::clamp(series.width, 0.8, 4.0));
    set_dash(context, series.dash, series.width);
    cairo_move_to(context, x, y);
    cairo_line_to(context, x + width, y);
    set_colour(context, colour);
    cairo_stroke(context);
  }
  const Marker marker = points && series.marker == Marker::kNone ? Marker::kDot : series.marker;
  mark(context, marker, x + width / 2, y, std::clamp(series.marker_size, 2.0, 8.0), colour);
}

}  // namespace wisp::drawing
