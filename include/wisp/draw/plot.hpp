#pragma once
// Plots described by values, drawn to a picture, PNG or SVG by one renderer. Every member has an initialiser, so that
// designated initialisers may omit any without a compiler warning.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "wisp/draw/image.hpp"

namespace wisp {

enum class SeriesShape { kLine, kPoints, kBars };
enum class Dash { kSolid, kDashed, kDotted };
enum class Marker { kNone, kDot, kRing };
enum class IntervalShape { kBars, kBand };

/// One data series of a plot. x and y have equal lengths; a y that is not finite interrupts the line.
struct PlotSeries {
  std::string label{};  ///< name in the legend; empty: not listed
  std::vector<double> x{};
  std::vector<double> y{};
  std::vector<double> low{};  ///< lower ends of intervals around y, as many as y; empty: none
  std::vector<double> high{};
  SeriesShape shape = SeriesShape::kLine;
  std::optional<Colour> colour{};  ///< unset: the palette's next
  double width = 1.6;              ///< line width, points; 0.1 … 20
  Dash dash = Dash::kSolid;
  Marker marker = Marker::kNone;  ///< marker at each sample
  double marker_size = 5;         ///< marker size, points; 0.5 … 50
  IntervalShape interval = IntervalShape::kBars;
};

/// A straight line across the plot with a label: a threshold, an event.
struct PlotMark {
  double at = 0;
  bool vertical = true;  ///< vertical line at an x; otherwise horizontal at a y
  std::string label{};
  std::optional<Colour> colour{};  ///< unset: a strong red
  Dash dash = Dash::kDashed;
};

/// One axis. Unset ends follow the data, with a margin.
struct PlotAxis {
  std::string label{};
  std::optional<double> lowest{};
  std::optional<double> highest{};
  bool logarithmic = false;    ///< values that are not positive are omitted
  bool whole_numbers = false;  ///< ticks at whole numbers only (indices)
};

/// Axes, data series and marks of one plot.
struct Plot {
  std::string title{};
  PlotAxis x{};
  PlotAxis y{};
  std::vector<PlotSeries> series{};  ///< later ones are drawn over earlier ones
  std::vector<PlotMark> marks{};
  bool equal_units = false;  ///< equal scales of x and y (trajectories)
};

/// Sets equal axis ranges in both plots, which contain the data of both and 0, so that sizes compare by eye.
void share_axes(Plot& a, Plot& b);

/// Plots side by side.
struct PlotSheet {
  std::string title{};          ///< title above all plots; empty: none
  std::vector<Plot> plots{};    ///< row by row
  int columns = 0;              ///< 0: all in one row
  double plot_width = 420;      ///< width of one plot with its labels, points; 80 … 4000
  double plot_height = 300;     ///< points; 80 … 4000
  double pixels_per_point = 2;  ///< resolution of the PNG; 0.25 … 8
};

/// Draws the sheet. Of series whose x and y differ in length, the common part is drawn.
/// Precondition: !sheet.plots.empty().
Image draw_plots(const PlotSheet& sheet);

/// Writes the sheet as PNG or SVG, by the path's extension. Text in SVG is shapes, so that it needs no font.
/// Errors: another extension, no plots, a picture larger than kLargestImageSide, the file cannot be written.
Result<void> write_plots(const std::filesystem::path& path, const PlotSheet& sheet);

}  // namespace wisp
