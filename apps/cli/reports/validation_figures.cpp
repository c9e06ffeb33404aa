#include "reports/validation_figures.hpp"

#include <cmath>

#include "reports/clip_figures.hpp"
#include "reports/outline_learning.hpp"
#include "wisp/draw/plot.hpp"
#include "wisp/learn/outline_shape.hpp"
#include "wisp/learn/spectrum.hpp"

namespace wisp::cli {
namespace {

namespace fs = std::filesystem;

Result<void> make_folder(const fs::path& folder) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) return Error{folder.string() + ": cannot be made: " + code.message()};
  return {};
}

std::vector<double> seconds_of(std::size_t rows, double rate_hz) {
  std::vector<double> seconds(rows);
  for (std::size_t row = 0; row < rows; ++row) seconds[row] = static_cast<double>(row) / rate_hz;
  return seconds;
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

// The tip's place beside or above the base, in model units of `unit` pixels, row by row; NaN where missing.
std::vector<double> tips(const Recording& recording, double unit, int coordinate) {
  const auto found = outline_layout(recording);
  if (!found) return std::vector<double>(recording.rows(), std::nan(""));
  const OutlineLayout& layout = *found;
  const OutlineCurve curve(layout.knots);
  std::vector<double> values;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    std::vector<double> control;
    for (std::size_t channel : layout.outputs) control.push_back(recording.channels[channel].samples[row]);
    const auto tip = tip_of(curve.polyline(control));
    const std::size_t last = control.size() - 2;
    const double base = (control[coordinate] + control[last + coordinate]) / 2;
    values.push_back((tip[coordinate] - base) / unit);
  }
  return values;
}

PlotSheet time_sheet(const Recording& recording, const Judged& judged) {
  const auto seconds = seconds_of(recording.rows(), recording.rate_hz);
  const double unit = judged.found.pixels_per_unit;
  const PredictedOutlines& shown = judged.shown();
  Plot tip{.title = "Tip, sideways", .x = {.label = "seconds"}, .y = {.label = "flame heights"}};
  tip.series = {{.label = "captured", .x = seconds, .y = tips(recording, unit, 0)},
                {.label = shown_as(shown), .x = seconds, .y = tips(shown.recording, unit, 0), .dash = Dash::kDashed}};
  PlotSheet sheet{.plots = {std::move(tip)}, .columns = 1, .plot_width = 900, .plot_height = 260};
  for (std::size_t channel : channels_with_role(recording, Role::kInput)) {
    const Channel& input = recording.channels[channel];
    // A unit of 1 is no unit: what of a sound is made into a wind is told as shares of a strong gust.
    const std::string of_wind = input.unit == "1" ? "1: a strong gust" : input.unit;
    Plot plot{.title = input.name, .x = {.label = "seconds"}, .y = {.label = of_wind}};
    plot.series = {{.x = seconds, .y = input.samples}};
    sheet.plots.push_back(std::move(plot));
  }
  return sheet;
}

// Runs of samples between missing ones.
std::vector<std::vector<double>> whole_stretches(const std::vector<double>& values) {
  std::vector<std::vector<double>> stretches(1);
  for (double value : values) {
    if (!std::isnan(value)) {
      stretches.back().push_back(value);
    } else if (!stretches.back().empty()) {
      stretches.emplace_back();
    }
  }
  return stretches;
}

PlotSheet spectrum_sheet(const Recording& recording, const Judged& judged) {
  const std::size_t samples = judged.found.fidelity ? judged.found.fidelity->welch_samples : 64;
  PlotSheet sheet;
  for (int coordinate : {0, 1}) {
    Plot plot{.title = coordinate == 0 ? "Flicker of the tip, sideways" : "Flicker of the tip, up and down",
              .x = {.label = "Hz"},
              .y = {.label = "power density", .logarithmic = true}};
    const auto add = [&](const std::string& label, const std::vector<double>& values, Dash dash) {
      const std::vector<std::vector<double>> stretches = whole_stretches(values);
      const Spectrum spectrum = welch(stretches, recording.rate_hz, samples);
      plot.series.push_back({.label = label, .x = spectrum.frequency_hz, .y = spectrum.power, .dash = dash});
    };
    const double unit = judged.found.pixels_per_unit * (coordinate == 0 ? 1 : -1);
    add("captured", tips(recording, unit, coordinate), Dash::kSolid);
    add("synthesized", tips(judged.found.played, unit, coordinate), Dash::kDashed);
    sheet.plots.push_back(std::move(plot));
  }
  return sheet;
}

}  // namespace

const PredictedOutlines& Judged::shown() const {
  constexpr int kLookAhead = 5;
  const PredictedOutlines* best = &found.predicted.front();
  for (const PredictedOutlines& predicted : found.predicted) {
    if (found.static_gain) {
      if (predicted.steps == kFreeRun) return predicted;
    } else if (predicted.steps != kFreeRun && predicted.steps <= kLookAhead) {
      best = &predicted;
    }
  }
  return *best;
}

std::string shown_as(const PredictedOutlines& predicted) {
  if (predicted.steps == kFreeRun) return "simulated from the input alone";
  return "predicted " + std::to_string(predicted.steps) + " frames ahead";
}

Result<void> write_validation_figures(const fs::path& folder, const Model& model, const Recording& recording,
                                      const Judged& judged) {
  if (auto ok = make_folder(folder); !ok) return ok;
  if (auto ok = write_figure(folder, "residual-noise", residual_sheet(model)); !ok) return ok;
  if (auto ok = write_figure(folder, "tip", time_sheet(recording, judged)); !ok) return ok;
  return write_figure(folder, "flicker", spectrum_sheet(recording, judged));
}

}  // namespace wisp::cli
