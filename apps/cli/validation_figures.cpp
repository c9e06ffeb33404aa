#include "validation_figures.hpp"

#include <cmath>

#include "clip_figures.hpp"
#include "outline_learning.hpp"
#include "recordings.hpp"
#include "wisp/draw/plot.hpp"
#include "wisp/learn/outline_shape.hpp"
#include "wisp/learn/residual_tests.hpp"
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

// One coordinate's residual standard deviation over the control points, with its interval.
PlotSeries residual_series(const ArxModel& arx, std::size_t coordinate, const std::string& label, Dash dash) {
  PlotSeries series{.label = label, .dash = dash, .marker = Marker::kDot};
  for (std::size_t point = 0; 2 * point < arx.noise.sd_ci95.size(); ++point) {
    const auto& interval = arx.noise.sd_ci95[2 * point + coordinate];
    series.x.push_back(static_cast<double>(point));
    series.y.push_back((interval[0] + interval[1]) / 2);
    series.low.push_back(interval[0]);
    series.high.push_back(interval[1]);
  }
  return series;
}

PlotSheet residual_sheet(const Model& model) {
  const auto& arx = std::get<ArxModel>(model.dynamics);
  Plot plot{.title = "Residual noise, with 95 % intervals",
            .x = {.label = "control point", .whole_numbers = true},
            .y = {.label = "standard deviation, flame heights", .lowest = 0.0}};
  plot.series = {residual_series(arx, 1, "vertical", Dash::kSolid),
                 residual_series(arx, 0, "horizontal", Dash::kDashed)};
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
    Plot plot{.title = input.name, .x = {.label = "seconds"}, .y = {.label = input.unit}};
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

ChannelChoice channels_of(const Model& model) {
  ChannelChoice channels;
  for (const Input& input : model.inputs) channels.inputs.push_back(input.name);
  for (const Output& output : model.outputs) channels.outputs.push_back(output.name);
  return channels;
}

Result<void> plot_plain(const fs::path& folder, const Model& model, const Recording& recording,
                        const ChannelChoice& channels) {
  if (auto ok = make_folder(folder); !ok) return ok;
  const auto simulated = predict(std::get<ArxModel>(model.dynamics), recording, channels, {.steps = kFreeRun});
  if (!simulated) return simulated.error();
  const auto seconds = seconds_of(recording.rows(), recording.rate_hz);
  PlotSheet sheet{.columns = 1, .plot_width = 900, .plot_height = 260};
  for (std::size_t k = 0; k < channels.outputs.size(); ++k) {
    Plot plot{.title = channels.outputs[k], .x = {.label = "seconds"}, .y = {.label = model.outputs[k].unit}};
    plot.series = {{.label = "measured",
                    .x = seconds,
                    .y = recording.channels[*find_channel(recording, channels.outputs[k])].samples},
                   {.label = "simulated from the input", .x = seconds, .y = (*simulated)[k], .dash = Dash::kDashed}};
    sheet.plots.push_back(std::move(plot));
  }
  return write_figure(folder, "simulation", sheet);
}

void report_plain(const std::vector<PredictionFigures>& figures, const ChannelChoice& channels,
                  const std::vector<double>& whiteness, Terminal& terminal) {
  std::vector<int> steps;
  for (const PredictionFigures& figure : figures) steps.push_back(figure.steps);
  Json& result = terminal.result();
  result["channels"] = Json::array();
  for (std::size_t k = 0; k < channels.outputs.size(); ++k) {
    std::vector<double> fits;
    for (const PredictionFigures& figure : figures) fits.push_back(figure.fit_percent[k]);
    result["channels"].push_back(
        {{"name", channels.outputs[k]}, {"fit_percent", by_steps(steps, fits)}, {"whiteness_p", number(whiteness[k])}});
  }
  std::vector<double> j;
  for (const PredictionFigures& figure : figures) j.push_back(mean_per_step({figure.j}).front());
  result["J"] = by_steps(steps, j);
  result["rows"] = figures.front().rows;
  for (std::size_t s = 0; s < figures.size(); ++s) {
    std::string line = steps[s] == kFreeRun ? "free simulation:" : std::to_string(steps[s]) + " ahead:";
    for (std::size_t k = 0; k < channels.outputs.size(); ++k)
      line += " " + channels.outputs[k] + " " + shown(figures[s].fit_percent[k], 4) + " %";
    terminal.say(line);
  }
}

std::vector<double> whiteness_of(const ArxModel& arx, const Recording& recording, const ChannelChoice& channels) {
  const auto tests = test_residuals(arx, {&recording, 1}, channels, {.lags = 20});
  if (!tests) return std::vector<double>(channels.outputs.size(), 1.0);  // too short: nothing speaks against white
  std::vector<double> p;
  for (const Whiteness& output : tests->whiteness) p.push_back(output.p);
  return p;
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

Result<void> validate_plain(const Model& model, const std::vector<int>& steps, const Arguments& arguments,
                            Terminal& terminal) {
  for (const char* flag : {"overlay", "film-strip"}) {
    if (arguments.has(flag))
      return Error{arguments.positional() + ": is not a model of an outline, so --" + flag + " has nothing to draw"};
  }
  const std::string& path = arguments.positionals()[1];
  if (!is_table(path)) return Error{path + ": is not a table (.csv), which this model is validated against"};
  auto whole = read_table(path, arguments, channels_of(model));
  if (!whole) return whole.error();
  const auto recording = in_range(std::move(*whole), arguments, "range");
  if (!recording) return recording.error();
  const ChannelChoice channels = channels_of(model);
  const auto& arx = std::get<ArxModel>(model.dynamics);
  const auto figures = prediction_figures(arx, {&*recording, 1}, channels, {.steps = steps});
  if (!figures) return figures.error();
  report_plain(*figures, channels, whiteness_of(arx, *recording, channels), terminal);
  if (!arguments.has("figures")) return {};
  return plot_plain(arguments.text("figures"), model, *recording, channels);
}

}  // namespace wisp::cli
