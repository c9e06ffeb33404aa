#pragma once
// Everything of a plot but its data: room, axes, grid, title, marks, legend.

#include <cairo.h>

#include "draw/plot/plot_scale.hpp"
#include "wisp/draw/plot.hpp"

namespace wisp::drawing {

/// The rectangle that data is drawn in, points.
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

/// Finds the range of the data and the room that labels leave for it in a panel of that size, whose data begin at
/// `left` or farther right.
Axes make_axes(cairo_t* context, const Plot& plot, double width, double height, double left = 0);

void draw_title(cairo_t* context, const std::string& title, const PlotBox& box);
void draw_grid(cairo_t* context, const Axes& axes);
void draw_axes(cairo_t* context, const Plot& plot, const Axes& axes);
void draw_spans(cairo_t* context, const Plot& plot, const Axes& axes);
void draw_marks(cairo_t* context, const Plot& plot, const Axes& axes);

/// The legend of the series stands in a line above the data, where it cannot hide any.
void draw_keys(cairo_t* context, const Plot& plot, const Axes& axes);

}  // namespace wisp::drawing
