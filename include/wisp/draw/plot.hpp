#pragma once
// Plots, described by values and drawn to a picture, PNG or SVG by one renderer. Every member has an initialiser, so
// that designated ones may leave any out without a compiler's warning.

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

/// One set of data of a plot. x and y have one length; y that is not finite breaks the line.
struct PlotSeries {
  std::string label{};  ///< in the legend; empty: not there
  std::vector<double> x{};
  std::vector<double> y{};
  std::vector<double> low{};  ///< ends of intervals around y, as long as y; empty: none
  std::vector<double> high{};
  SeriesShape shape = SeriesShape::kLine;
  std::optional<Colour> colour{};  ///< unset: the palette's next
  double width = 1.6;              ///< of lines, in points; 0.1 … 20
  Dash dash = Dash::kSolid;
  Marker marker = Marker::kNone;  ///< at each sample
  double marker_size = 5;         ///< in points; 0.5 … 50
  IntervalShape interval = IntervalShape::kBars;
};

/// A straight line across the plot with a word beside it: a threshold, an event.
struct PlotMark {
  double at = 0;
  bool vertical = true;  ///< at an x; otherwise at a y
  std::string label{};
  std::optional<Colour> colour{};  ///< unset: a strong red
  Dash dash = Dash::kDashed;
};

/// One axis. Unset ends follow the data, rounded to ticks.
struct PlotAxis {
  std::string label{};
  std::optional<double> lowest{};
  std::optional<double> highest{};
  bool logarithmic = false;    ///< values that are not positive are left out
  bool whole_numbers = false;  ///< ticks at whole numbers only (indices)
};

/// Axes with data.
struct Plot {
  std::string title{};
  PlotAxis x{};
  PlotAxis y{};
  std::vector<PlotSeries> series{};  ///< later ones are drawn over earlier ones
  std::vector<PlotMark> marks{};
  bool equal_units = false;  ///< one unit is as long in x as in y (trajectories)
};

/// Gives both plots the ends that hold the data of both, 0 included, so that the eye compares sizes.
void share_axes(Plot& a, Plot& b);

/// Plots side by side.
struct PlotSheet {
  std::string title{};        ///< above all of them; empty: none
  std::vector<Plot> plots{};  ///< row by row
  int columns = 0;            ///< 0: all in one row
  double plot_width = 420;    ///< of one plot with its labels, in points; 80 … 4000
  double plot_height = 300;
  double pixels_per_point = 2;  ///< of the PNG; 0.25 … 8
};

/// Draws the sheet. Series whose x and y differ in length are drawn as far as both go.
///
/// Precondition: !sheet.plots.empty().
Image draw_plots(const PlotSheet& sheet);

/// Writes the sheet as PNG or SVG, by the path's extension. Text in SVG is shapes, so that it needs no font.
/// Errors: another extension, no plots, a picture larger than kLargestImageSide, the file cannot be written.
Result<void> write_plots(const std::filesystem::path& path, const PlotSheet& sheet);

}  // namespace wisp
