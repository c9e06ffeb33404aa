#include "reports/validation_figures.hpp"

#include "reports/clip_figures.hpp"
#include "wisp/draw/plot.hpp"

namespace wisp::cli {
namespace {

namespace fs = std::filesystem;

Result<void> make_folder(const fs::path& folder) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) return Error{folder.string() + ": cannot be made: " + code.message()};
  return {};
}

// What the fit left of a channel, which the file tells since its noise may be shared; the middle of the interval where
// it does not.
double residual_sd(const Model& model, std::size_t channel) {
  if (!model.training.residual_sd.empty()) return model.training.residual_sd[channel];
  const auto& interval = std::get<ArxModel>(model.dynamics).noise.sd_ci95[channel];
  return (interval[0] + interval[1]) / 2;
}

// One coordinate's residual standard deviation over the control points, with its interval.
PlotSeries residual_series(const Model& model, std::size_t coordinate, const std::string& label, Dash dash) {
  const auto& intervals = std::get<ArxModel>(model.dynamics).noise.sd_ci95;
  PlotSeries series{.label = label, .dash = dash, .marker = Marker::kDot};
  for (std::size_t point = 0; 2 * point < intervals.size(); ++point) {
    const auto& interval = intervals[2 * point + coordinate];
    series.x.push_back(static_cast<double>(point));
    series.y.push_back(residual_sd(model, 2 * point + coordinate));
    series.low.push_back(interval[0]);
    series.high.push_back(interval[1]);
  }
  return series;
}

PlotSheet residual_sheet(const Model& model) {
  Plot plot{.title = "Residual noise, with 95 % intervals",
            .x = {.label = "control point", .whole_numbers = true},
            .y = {.label = "standard deviation, flame heights", .lowest = 0.0}};
  plot.series = {residual_series(model, 1, "vertical", Dash::kSolid),
                 residual_series(model, 0, "horizontal", Dash::kDashed)};
  return {.plots = {std::move(plot)}};
}

// A plot for every section with series whose ids begin with `prefix`.
std::vector<Plot> plots_of(const Report& report, std::string_view prefix) {
  std::vector<Plot> plots;
  for (const ReportSection& section : report.sections) {
    if (section.series.empty() || !section.series.front().id.starts_with(prefix)) continue;
    const ReportSeries& first = section.series.front();
    Plot plot{.title = section.title, .x = {.label = first.x_label}, .y = {.label = first.y_label}};
    for (const ReportSeries& series : section.series) {
      const Dash dash = &series == &first ? Dash::kSolid : Dash::kDashed;
      plot.series.push_back({.label = series.label, .x = series.x, .y = series.y, .dash = dash});
    }
    plots.push_back(std::move(plot));
  }
  return plots;
}

PlotSheet time_sheet(const Report& report) {
  PlotSheet sheet{.plots = plots_of(report, "tip."), .columns = 1, .plot_width = 900, .plot_height = 260};
  for (Plot& plot : plots_of(report, "input.")) sheet.plots.push_back(std::move(plot));
  return sheet;
}

PlotSheet spectrum_sheet(const Report& report) {
  PlotSheet sheet{.plots = plots_of(report, "flicker.")};
  for (Plot& plot : sheet.plots) plot.y.logarithmic = true;
  return sheet;
}

}  // namespace

Result<void> write_validation_figures(const fs::path& folder, const Model& model, const Report& report) {
  if (auto ok = make_folder(folder); !ok) return ok;
  if (auto ok = write_figure(folder, "residual-noise", residual_sheet(model)); !ok) return ok;
  if (auto ok = write_figure(folder, "tip", time_sheet(report)); !ok) return ok;
  return write_figure(folder, "flicker", spectrum_sheet(report));
}

}  // namespace wisp::cli
