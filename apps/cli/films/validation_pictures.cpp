#include "films/validation_pictures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <vector>

#include "reports/clip_figures.hpp"
#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/draw/flame.hpp"
#include "wisp/draw/plot.hpp"
#include "wisp/learn/validate.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {
namespace {

// ---- Plots of `wisp validate --figures` for outlines ----

namespace fs = std::filesystem;

// Returns the residual standard deviation of a channel; if the training record lacks it, the middle of its interval.
double residual_sd(const Model& model, std::size_t channel) {
  if (!model.training.residual_sd.empty()) return model.training.residual_sd[channel];
  const auto& interval = std::get<ArxModel>(model.dynamics).noise.sd_ci95[channel];
  return (interval[0] + interval[1]) / 2;
}

// Returns the residual standard deviation of one coordinate over the control points, with its interval.
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

// Returns one plot for every section whose first series has an id that begins with `prefix`.
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

constexpr std::size_t kColumns = 12;

// Returns the horizontal offset of the tip from the middle of the base; NaN without an outline.
double lean_of(const std::vector<std::array<double, 2>>& outline) {
  if (outline.empty()) return std::numeric_limits<double>::quiet_NaN();
  return outline[outline.size() / 2][0] - (outline.front()[0] + outline.back()[0]) / 2;
}

// Returns the rows of a film strip: twelve moments (fewer in a short recording), an eighth of a second apart, in the
// stretch with complete outlines in which the captured tip moves most.
std::vector<std::size_t> liveliest_rows(const OutlineRows& captured, double rate_hz) {
  const auto apart = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(rate_hz / 8)));
  const std::size_t count = std::min(kColumns, (captured.size() + apart - 1) / apart);
  std::size_t best = 0;
  double most = -1;
  for (std::size_t begin = 0; begin + count * apart < captured.size() + apart; begin += apart) {
    double motion = 0;
    for (std::size_t k = 1; k < count; ++k)
      motion += std::abs(lean_of(captured[begin + k * apart]) - lean_of(captured[begin + (k - 1) * apart]));
    if (motion > most) best = begin, most = motion;  // false for NaN
  }
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < count; ++k) rows.push_back(best + k * apart);
  return rows;
}

}  // namespace

Result<void> draw_validation(const ValidatedOutline& found, const Model& model, const ValidationSubject& subject,
                             const ValidationPictures& pictures, Terminal& terminal) {
  if (!pictures.overlay.empty()) {
    const OverlayContent content{found.captured, found.simulated, found.simulated_label};
    if (auto ok = write_overlay(pictures.overlay, subject.clip, subject.recording, content, terminal); !ok) return ok;
    terminal.say("wrote " + pictures.overlay);
  }
  if (!pictures.film_strip.empty()) {
    const StripContent content{
        .rows = liveliest_rows(found.captured, subject.recording.rate_hz),
        .rate_hz = subject.recording.rate_hz,
        .captured = found.captured,
        .synthesized = found.played,
        .pixels_per_unit = found.pixels_per_unit,
        .flame = is_flame(model),
        .synthesized_caption = model.inputs.empty() ? "synthesized" : "synthesized, in the same wind"};
    if (auto ok = write_film_strip(pictures.film_strip, subject.clip, content); !ok) return ok;
    terminal.say("wrote " + pictures.film_strip);
  }
  const std::string& folder = pictures.figures;
  if (folder.empty()) return {};
  if (auto ok = write_figure(folder, "residual-noise", residual_sheet(model)); !ok) return ok;
  if (auto ok = write_figure(folder, "tip", time_sheet(found.report)); !ok) return ok;
  if (auto ok = write_figure(folder, "flicker", spectrum_sheet(found.report)); !ok) return ok;
  if (subject.captured) {
    const std::size_t skipped = clip_of(subject.recording, {}).first_frame;
    if (auto ok = write_clip_figures(folder, subject.clip.path, skipped, *subject.captured); !ok) return ok;
  }
  terminal.say("wrote figures to " + folder);
  return {};
}

}  // namespace wisp::cli
