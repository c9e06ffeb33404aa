#include "reports/arx_validation.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "flags/recordings.hpp"
#include "reports/arx_figures.hpp"
#include "reports/clip_figures.hpp"
#include "reports/curve_learning.hpp"
#include "reports/figures_json.hpp"
#include "wisp/draw/plot.hpp"
#include "wisp/learn/prediction.hpp"

namespace wisp::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kSure = 1.959963985;  // standard deviations to either side of 95 %
constexpr int kSettled = 2000;         // steps after which the noise of free simulation has its full size

ChannelChoice channels_of(const Model& model) {
  ChannelChoice channels;
  for (const Input& input : model.inputs) channels.inputs.push_back(input.name);
  for (const Output& output : model.outputs) channels.outputs.push_back(output.name);
  return channels;
}

// With the inputs as the linear half of the model sees them.
Recording bent(const Recording& recording, const Model& model) {
  std::vector<InputCurve> curves;
  for (const Input& input : model.inputs) curves.push_back(input.curve);
  return bent_recordings({&recording, 1}, channels_of(model).inputs, curves).front();
}

InitialState initial_of(const Arguments& arguments) {
  if (arguments.text("initial") == "zero") return InitialState::kZero;
  return arguments.text("initial") == "estimated" ? InitialState::kEstimated : InitialState::kMeasured;
}

// All that is judged with.
struct Subject {
  const Model& model;
  const ArxModel& arx;
  const ChannelChoice& channels;
  const Recording& recording;
  std::vector<int> steps;
  InitialState initial = InitialState::kMeasured;
  std::vector<std::vector<double>> sd;  // of prediction errors, per output, then per step

  const std::vector<double>& measured(std::size_t output) const {
    return recording.channels[*find_channel(recording, channels.outputs[output])].samples;
  }
  double sd_of(std::size_t output, int step) const {
    return step == kFreeRun ? sd[output].back() : sd[output][static_cast<std::size_t>(step) - 1];
  }
};

// Standard deviations as far as the longest prediction, or until they settle.
std::vector<std::vector<double>> error_sd(const ArxModel& arx, const std::vector<int>& steps) {
  int most = *std::max_element(steps.begin(), steps.end());
  if (std::find(steps.begin(), steps.end(), kFreeRun) != steps.end()) most = std::max(most, kSettled);
  return prediction_sd(arx, {}, most);
}

// Predictions of every number of steps: [step][output][row].
using Predictions = std::vector<std::vector<std::vector<double>>>;

Result<Predictions> all_predictions(const Subject& subject) {
  Predictions all;
  for (int step : subject.steps) {
    auto predicted = predict(subject.arx, subject.recording, subject.channels, {step, subject.initial});
    if (!predicted) return predicted.error();
    all.push_back(std::move(*predicted));
  }
  return all;
}

// The share of measured rows within the model's own 95 % interval.
double share_inside(const std::vector<double>& measured, const std::vector<double>& predicted, double sd) {
  std::size_t rows = 0, inside = 0;
  for (std::size_t t = 0; t < measured.size(); ++t) {
    const double error = measured[t] - predicted[t];
    if (!std::isfinite(error)) continue;
    ++rows;
    inside += std::abs(error) <= kSure * sd;
  }
  return rows > 0 ? static_cast<double>(inside) / static_cast<double>(rows) : 0;
}

Json independence_json(const ResidualTests& tests, const ChannelChoice& channels, std::size_t output) {
  Json json = Json::object();
  for (std::size_t k = 0; k < channels.inputs.size(); ++k) {
    json[channels.inputs[k]] = number(tests.independence[output][k].p);
  }
  return json;
}

Json channel_json(const Subject& subject, const std::vector<PredictionFigures>& figures, const Predictions& predictions,
                  const std::optional<ResidualTests>& tests, std::size_t output) {
  std::vector<double> fit, rms, sd, inside;
  for (std::size_t s = 0; s < figures.size(); ++s) {
    fit.push_back(figures[s].fit_percent[output]);
    rms.push_back(std::sqrt(figures[s].mean_square[output]));
    sd.push_back(subject.sd_of(output, subject.steps[s]));
    inside.push_back(share_inside(subject.measured(output), predictions[s][output], sd.back()));
  }
  return {{"name", subject.channels.outputs[output]},
          {"fit_percent", by_steps(subject.steps, fit)},
          {"whiteness_p", tests ? number(tests->whiteness[output].p) : Json(nullptr)},
          {"independence_p", tests ? independence_json(*tests, subject.channels, output) : Json(nullptr)},
          {"rms_error", by_steps(subject.steps, rms)},
          {"predicted_sd", by_steps(subject.steps, sd)},
          {"inside_95_percent_interval", by_steps(subject.steps, inside)}};
}

void say_figures(const Subject& subject, const std::vector<PredictionFigures>& figures,
                 const std::optional<ResidualTests>& tests, Terminal& terminal) {
  for (std::size_t s = 0; s < figures.size(); ++s) {
    std::string line = subject.steps[s] == kFreeRun ? "free simulation:" : std::to_string(subject.steps[s]) + " ahead:";
    for (std::size_t k = 0; k < subject.channels.outputs.size(); ++k)
      line += " " + subject.channels.outputs[k] + " " + shown(figures[s].fit_percent[k], 4) + " %";
    terminal.say(line);
  }
  if (!tests) return;
  for (std::size_t i = 0; i < subject.channels.outputs.size(); ++i) {
    std::string line = "residual of " + subject.channels.outputs[i] + ": white p " + shown(tests->whiteness[i].p, 2);
    for (std::size_t k = 0; k < subject.channels.inputs.size(); ++k) {
      line += ", independent of " + subject.channels.inputs[k] + " p " + shown(tests->independence[i][k].p, 2);
    }
    terminal.say(line);
  }
}

void report(const Subject& subject, const std::vector<PredictionFigures>& figures, const Predictions& predictions,
            const std::optional<ResidualTests>& tests, Terminal& terminal) {
  Json& result = terminal.result();
  result["channels"] = Json::array();
  for (std::size_t i = 0; i < subject.channels.outputs.size(); ++i) {
    result["channels"].push_back(channel_json(subject, figures, predictions, tests, i));
  }
  std::vector<double> j;
  for (const PredictionFigures& figure : figures) j.push_back(mean_per_step({figure.j}).front());
  result["J"] = by_steps(subject.steps, j);
  result["rows"] = figures.front().rows;
  say_figures(subject, figures, tests, terminal);
}

// A picture of more rows than it has pixels shows nothing.
constexpr std::size_t kMostRowsShown = 1000;

std::vector<double> first_rows(const std::vector<double>& values, std::size_t first, std::size_t rows) {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(std::min(first, values.size()));
  return {begin, begin + static_cast<std::ptrdiff_t>(std::min(rows, values.size() - first))};
}

std::vector<double> seconds_of(std::size_t first, std::size_t rows, double rate_hz) {
  std::vector<double> seconds;
  for (std::size_t t = first; t < first + rows; ++t) seconds.push_back(static_cast<double>(t) / rate_hz);
  return seconds;
}

std::string said_fit(double percent) { return " (fit " + shown(percent, 3) + " %)"; }

PlotSheet simulation_sheet(const Subject& subject, const std::vector<std::vector<double>>& simulated,
                           const PredictionFigures& figures) {
  PlotSheet sheet{.columns = 1, .plot_width = 900, .plot_height = 260};
  const std::size_t rows = std::min(subject.recording.rows(), kMostRowsShown);
  const auto seconds = seconds_of(0, rows, subject.recording.rate_hz);
  for (std::size_t i = 0; i < subject.channels.outputs.size(); ++i) {
    Plot plot{
        .title = subject.channels.outputs[i], .x = {.label = "seconds"}, .y = {.label = subject.model.outputs[i].unit}};
    if (rows < subject.recording.rows()) plot.title += ", the first " + std::to_string(rows) + " rows";
    plot.series = {{.label = "measured", .x = seconds, .y = first_rows(subject.measured(i), 0, rows)},
                   {.label = "simulated from the input" + said_fit(figures.fit_percent[i]),
                    .x = seconds,
                    .y = first_rows(simulated[i], 0, rows),
                    .dash = Dash::kDashed}};
    sheet.plots.push_back(std::move(plot));
  }
  return sheet;
}

PlotSheet prediction_sheet(const Subject& subject, const std::vector<std::vector<double>>& predicted, int step) {
  // Few enough rows that the interval's width can be seen.
  constexpr std::size_t kRows = 200;
  PlotSheet sheet{.columns = 1, .plot_width = 900, .plot_height = 260};
  const auto first = static_cast<std::size_t>(subject.arx.orders.history() + step - 1);
  const std::size_t rows = std::min(subject.recording.rows() - std::min(first, subject.recording.rows()), kRows);
  const auto seconds = seconds_of(first, rows, subject.recording.rate_hz);
  for (std::size_t i = 0; i < subject.channels.outputs.size(); ++i) {
    Plot plot{.title = subject.channels.outputs[i] + ", " + std::to_string(step) +
                       (step == 1 ? " sample ahead" : " samples ahead"),
              .x = {.label = "seconds"},
              .y = {.label = subject.model.outputs[i].unit}};
    PlotSeries series{.label = "predicted, with the model's 95 % interval",
                      .x = seconds,
                      .y = first_rows(predicted[i], first, rows),
                      .interval = IntervalShape::kBand};
    for (double value : series.y) {
      series.low.push_back(value - kSure * subject.sd_of(i, step));
      series.high.push_back(value + kSure * subject.sd_of(i, step));
    }
    plot.series = {std::move(series),
                   {.label = "measured",
                    .x = seconds,
                    .y = first_rows(subject.measured(i), first, rows),
                    .shape = SeriesShape::kPoints,
                    .marker = Marker::kDot,
                    .marker_size = 4}};
    sheet.plots.push_back(std::move(plot));
  }
  return sheet;
}

// The paper's figure of prediction: error against the number of steps, beside what the model itself expects.
Result<PlotSheet> growth_sheet(const Subject& subject) {
  FigureOptions options;
  options.steps.clear();
  options.initial = subject.initial;
  for (int k = 1; k <= 20; ++k) options.steps.push_back(k);
  if (!subject.channels.inputs.empty()) options.steps.push_back(kFreeRun);
  const auto figures = prediction_figures(subject.arx, {&subject.recording, 1}, subject.channels, options);
  if (!figures) return figures.error();
  const auto expected = prediction_sd(subject.arx, {}, 20);
  PlotSheet sheet{.columns = static_cast<int>(std::min<std::size_t>(3, subject.channels.outputs.size()))};
  for (std::size_t i = 0; i < subject.channels.outputs.size(); ++i) {
    Plot plot{.title = "Prediction error of " + subject.channels.outputs[i],
              .x = {.label = "samples ahead", .whole_numbers = true},
              .y = {.label = "root mean square", .lowest = 0.0}};
    PlotSeries measured{.label = "measured", .marker = Marker::kDot};
    PlotSeries free_run{.label = "free simulation", .dash = Dash::kDotted};
    for (const PredictionFigures& figure : *figures) {
      const double rms = std::sqrt(figure.mean_square[i]);
      if (figure.steps == kFreeRun) {
        free_run.x = {1, 20};
        free_run.y = {rms, rms};
      } else {
        measured.x.push_back(figure.steps);
        measured.y.push_back(rms);
      }
    }
    PlotSeries own{.label = "expected by the model", .x = measured.x, .y = expected[i], .dash = Dash::kDashed};
    plot.series = {std::move(measured), std::move(own)};
    if (!free_run.x.empty()) plot.series.push_back(std::move(free_run));
    sheet.plots.push_back(std::move(plot));
  }
  return sheet;
}

Result<void> draw(const Subject& subject, const std::vector<PredictionFigures>& figures, const Predictions& predictions,
                  const std::optional<ResidualTests>& tests, const fs::path& folder) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) return Error{folder.string() + ": cannot be made: " + code.message()};
  int ahead = 0;
  std::size_t at = 0;
  for (std::size_t s = 0; s < subject.steps.size(); ++s) {
    if (subject.steps[s] == kFreeRun) {
      if (auto ok = write_figure(folder, "simulation", simulation_sheet(subject, predictions[s], figures[s])); !ok)
        return ok;
    } else if (subject.steps[s] > ahead && subject.steps[s] <= 15) {
      ahead = subject.steps[s];
      at = s;
    }
  }
  if (ahead > 0) {
    if (auto ok = write_figure(folder, "prediction", prediction_sheet(subject, predictions[at], ahead)); !ok) return ok;
  }
  if (const auto growth = growth_sheet(subject)) {  // none where the recording is shorter than twenty steps
    if (auto ok = write_figure(folder, "prediction-error", *growth); !ok) return ok;
  }
  if (tests) {
    if (auto ok = write_residual_figure(folder, *tests, subject.channels); !ok) return ok;
  }
  return write_response_figures(folder, {subject.arx, subject.channels, subject.recording.rate_hz});
}

}  // namespace

Result<void> validate_plain(const Model& model, const std::vector<int>& steps, const Arguments& arguments,
                            Terminal& terminal) {
  for (const char* flag : {"overlay", "film-strip"}) {
    if (arguments.has(flag))
      return Error{arguments.positional() + ": is not a model of an outline, so --" + flag + " has nothing to draw"};
  }
  const std::string& path = arguments.positionals()[1];
  if (!is_table(path)) return Error{path + ": is not a table (.csv), which this model is validated against"};
  const ChannelChoice channels = channels_of(model);
  auto whole = read_table(path, arguments, channels);
  if (!whole) return whole.error();
  const auto ranged = in_range(std::move(*whole), arguments, "range");
  if (!ranged) return ranged.error();
  const Recording recording = bent(*ranged, model);
  const auto& arx = std::get<ArxModel>(model.dynamics);
  const Subject subject{model, arx, channels, recording, steps, initial_of(arguments), error_sd(arx, steps)};
  const auto figures = prediction_figures(arx, {&recording, 1}, channels, {.steps = steps, .initial = subject.initial});
  if (!figures) return figures.error();
  const auto predictions = all_predictions(subject);
  if (!predictions) return predictions.error();
  const auto tested = test_residuals(arx, {&recording, 1}, channels, {.lags = 20});
  const auto tests = tested ? std::optional(*tested) : std::nullopt;  // too short: nothing can be said
  report(subject, *figures, *predictions, tests, terminal);
  if (!arguments.has("figures")) return {};
  return draw(subject, *figures, *predictions, tests, arguments.text("figures"));
}

}  // namespace wisp::cli
