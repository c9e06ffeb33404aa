#pragma once
// The data of a plot, drawn between its axes.

#include <cairo.h>

#include "draw/plot/plot_scale.hpp"
#include "wisp/draw/plot.hpp"

namespace wisp::drawing {

/// The colour that a series has when it names none: the palette's, by its place among the series.
Colour series_colour(const PlotSeries& series, std::size_t place);

void draw_series(cairo_t* context, const PlotSeries& series, Colour colour, const Scale& x, const Scale& y);

/// The series as it looks, in a legend: from (x, y) to the right.
void draw_sample(cairo_t* context, const PlotSeries& series, Colour colour, double x, double y, double width);

void set_dash(cairo_t* context, Dash dash, double width);

/// How wide bars are, in data units: the smallest step between them; 1 for a single one.
double bar_width(const PlotSeries& series);

}  // namespace wisp::drawing
