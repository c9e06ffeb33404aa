#pragma once
// Parts of a plot: ranges, layout, axes, grid, title, marks, legend and data.

#include <cairo.h>

#include "draw/plot/plot_scale.hpp"
#include "wisp/draw/plot.hpp"

namespace wisp::drawing {

/// The rectangle of the data area, points.
struct PlotBox {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;
  double width() const { return right - left; }
  double height() const { return bottom - top; }
};

struct Axes {
  PlotBox box;
  Scale x;
  Scale y;
  Ticks x_ticks;
  Ticks y_ticks;
};

/// Computes data ranges and label space of a panel of that size, whose data area begins at `left` or farther right.
Axes make_axes(cairo_t* context, const Plot& plot, double width, double height, double left = 0);

void draw_title(cairo_t* context, const std::string& title, const PlotBox& box);
void draw_grid(cairo_t* context, const Axes& axes);
void draw_axes(cairo_t* context, const Plot& plot, const Axes& axes);
void draw_marks(cairo_t* context, const Plot& plot, const Axes& axes);

/// Draws the legend of the series in lines above the data area.
void draw_keys(cairo_t* context, const Plot& plot, const Axes& axes);

/// Returns the colour of a series: its own, or the palette's colour by its index.
Colour series_colour(const PlotSeries& series, std::size_t place);

void draw_series(cairo_t* context, const PlotSeries& series, Colour colour, const Scale& x, const Scale& y);

/// Draws a sample of the series' style for a legend, from (x, y) to the right.
void draw_sample(cairo_t* context, const PlotSeries& series, Colour colour, double x, double y, double width);

void set_dash(cairo_t* context, Dash dash, double width);

/// Returns the width of bars in data units: the smallest step between neighbours; 1 for a single bar.
double bar_width(const PlotSeries& series);

}  // namespace wisp::drawing
