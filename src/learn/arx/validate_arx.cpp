// Validation of a plain ARX model on a recording.

#include <algorithm>
#include <cmath>
#include <string>

#include "base/statistics.hpp"
#include "learn/arx/learn_arx.hpp"
#include "learn/judge/prediction.hpp"
#include "learn/judge/residual_tests.hpp"
#include "learn/numeric/constants.hpp"
#include "learn/report/fit_report.hpp"
#include "learn/report/report_values.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace arx {
namespace {

constexpr int kMaxPlottedSteps = 15;  // maximum plotted horizon; longer predictions are practically simulations
constexpr int kErrorSteps = 20;       // number of steps in the plot of errors over steps

// Model, recording and options under validation.
struct Subject {
  const Model& model;
  const ArxModel& arx;
  const ChannelChoice& channels;
  const Recording& recording;
  const ValidationOptions& options;
  std::vector<std::vector<double>> sd;  // standard deviations of prediction errors: [output][step − 1]
  std::vector<double> moved;            // added to every output of the recording by seen_by()

  const std::vector<double>& measured(std::size_t output) const {
    return recording.channels[*find_channel(recording, channels.outputs[output])].samples;
  }
  double sd_of(std::size_t output, int step) const {
    return step == kFreeRun ? sd[output].back() : sd[output][static_cast<std::size_t>(step) - 1];
  }
};

// Predictions for each number of steps: [step][output][row], and their accuracy.
struct Judged {
  std::vector<PredictionFigures> figures;
  std::vector<std::vector<std::vector<double>>> predictions;
  std::optional<ResidualTests> tests{};  // empty where the recording is too short
};

// Standard deviations of prediction errors up to the longest horizon; free simulation counts as kSettledSteps.
std::vector<std::vector<double>> error_sd(const ArxModel& arx, const std::vector<int>& steps) {
  int longest = *std::max_element(steps.begin(), steps.end());
  if (std::find(steps.begin(), steps.end(), kFreeRun) != steps.end()) longest = std::max(longest, kSettledSteps);
  return prediction_sd(arx, longest);
}

Result<Judged> judge(const Subject& subject, const Progress& progress) {
  const std::vector<int>& steps = subject.options.steps;
  const InitialState initial = subject.options.initial;
  auto figures =
      prediction_figures(subject.arx, {&subject.recording, 1}, subject.channels, {.steps = steps, .initial = initial});
  if (!figures) return Error{subject.recording.source + ": " + figures.error().message};
  Judged judged{std::move(*figures), {}};
  for (std::size_t s = 0; s < steps.size(); ++s) {
    const double share = static_cast<double>(s) / static_cast<double>(steps.size());
    if (auto ok = check_progress(progress, "predicting", share); !ok) return ok.error();
    auto predicted = predict(subject.arx, subject.recording, subject.channels, {steps[s], initial});
    if (!predicted) return predicted.error();
    judged.predictions.push_back(std::move(*predicted));
  }
  const auto tests = test_residuals(subject.arx, {&subject.recording, 1}, subject.channels, {.lags = kReportedLags});
  if (tests) judged.tests = *tests;
  return judged;
}

// Share of measured rows within the model's own 95 % interval.
double share_inside(const std::vector<double>& measured, const std::vector<double>& predicted, double sd) {
  std::size_t rows = 0, inside = 0;
  for (std::size_t t = 0; t < measured.size(); ++t) {
    const double error = measured[t] - predicted[t];
    if (!std::isfinite(error)) continue;
    ++rows;
    inside += std::abs(error) <= kNormal95 * sd;
  }
  return rows > 0 ? static_cast<double>(inside) / static_cast<double>(rows) : 0;
}

std::string steps_label(int steps) { return steps == kFreeRun ? "free" : std::to_string(steps) + " ahead"; }

ReportTable channel_table(const Subject& subject, const Judged& judged) {
  ReportTable table{"channels", "every output", {{"name", "output"}}, {}};
  for (const std::string& output : subject.channels.outputs) table.rows.push_back({output});
  for (const PredictionFigures& figure : judged.figures) {
    add_column(table, {"fit_percent." + steps_id(figure.steps), "fit " + steps_label(figure.steps), "%"},
               [&](std::size_t i) { return figure.fit_percent[i]; });
  }
  const auto& tests = judged.tests;
  add_column(table, {"whiteness_p", "residual white, p"},
             [&](std::size_t i) { return tests ? tests->whiteness[i].p : kMissing; });
  for (std::size_t k = 0; k < subject.channels.inputs.size(); ++k) {
    const std::string& input = subject.channels.inputs[k];
    add_column(table, {"independence_p." + as_id(input), "independent of " + input + ", p"},
               [&](std::size_t i) { return tests ? tests->independence[i][k].p : kMissing; });
  }
  for (std::size_t s = 0; s < judged.figures.size(); ++s) {
    const int steps = subject.options.steps[s];
    const std::string id = steps_id(steps);
    const auto sd = [&](std::size_t i) { return subject.sd_of(i, steps); };
    add_column(table, {"rms_error." + id, ""},
               [&](std::size_t i) { return std::sqrt(judged.figures[s].mean_square[i]); });
    add_column(table, {"predicted_sd." + id, ""}, sd);
    add_column(table, {"inside_95_percent_interval." + id, ""},
               [&](std::size_t i) { return share_inside(subject.measured(i), judged.predictions[s][i], sd(i)); });
  }
  return table;
}

// Adds measured, simulated and predicted series; predicted is the longest prediction of at most kMaxPlottedSteps.
void add_plots(const Subject& subject, const Judged& judged, ReportSection& section) {
  const std::vector<double> seconds = seconds_of(subject.recording);
  const auto& steps = subject.options.steps;
  int ahead = 0;
  for (int step : steps) {
    if (step <= kMaxPlottedSteps) ahead = std::max(ahead, step);
  }
  for (std::size_t i = 0; i < subject.channels.outputs.size(); ++i) {
    const std::string place = "." + std::to_string(i), unit = subject.model.outputs[i].unit;
    const auto plot = [&](const std::string& id, const std::string& label, std::vector<double> y) {
      for (double& value : y) value -= subject.moved[i];
      section.series.push_back({id, label, "time, s", unit, seconds, std::move(y)});
    };
    plot("measured" + place, "measured", subject.measured(i));
    for (std::size_t s = 0; s < steps.size(); ++s) {
      const std::vector<double>& predicted = judged.predictions[s][i];
      const std::string fit = " (fit " + number_text(judged.figures[s].fit_percent[i], 3) + " %)";
      if (steps[s] == kFreeRun) plot("simulated" + place, "simulated from the input" + fit, predicted);
      if (steps[s] != ahead || ahead == 0) continue;
      std::vector<double> low = predicted, high = predicted;
      for (double& y : low) y -= kNormal95 * subject.sd_of(i, ahead);
      for (double& y : high) y += kNormal95 * subject.sd_of(i, ahead);
      const std::string samples = std::to_string(ahead) + (ahead == 1 ? " sample ahead" : " samples ahead");
      plot("predicted" + place, samples, predicted);
      plot("predicted" + place + ".low", samples, std::move(low));
      plot("predicted" + place + ".high", samples, std::move(high));
    }
  }
}

// Adds the RMS error over the number of steps, as measured and as expected from the model's noise, and that of free
// simulation. Adds nothing where no stretch of the recording is long enough for twenty steps.
void add_error_growth(const Subject& subject, ReportSection& section) {
  FigureOptions options;
  options.steps.clear();
  options.initial = subject.options.initial;
  for (int k = 1; k <= kErrorSteps; ++k) options.steps.push_back(k);
  if (!subject.channels.inputs.empty()) options.steps.push_back(kFreeRun);
  const auto figures = prediction_figures(subject.arx, {&subject.recording, 1}, subject.channels, options);
  if (!figures) return;
  const auto expected = prediction_sd(subject.arx, kErrorSteps);
  for (std::size_t i = 0; i < subject.channels.outputs.size(); ++i) {
    const std::string id = "error." + std::to_string(i);
    const auto series = [&](const std::string& place, const std::string& label) {
      return ReportSeries{id + place, label, "samples ahead", "root mean square", {}, {}};
    };
    ReportSeries measured = series("", "measured"), own = series(".model", "expected by the model"),
                 free_run = series(".inf", "free simulation");
    for (const PredictionFigures& figure : *figures) {
      const double rms = std::sqrt(figure.mean_square[i]);
      if (figure.steps == kFreeRun) {
        free_run.x = {1, kErrorSteps};
        free_run.y = {rms, rms};
      } else {
        measured.x.push_back(figure.steps);
        measured.y.push_back(rms);
      }
    }
    own.x = measured.x;
    own.y = expected[i];
    section.series.push_back(std::move(measured));
    section.series.push_back(std::move(own));
    if (!free_run.x.empty()) section.series.push_back(std::move(free_run));
  }
}

Report report_of(const Subject& subject, const Judged& judged) {
  Report report;
  ReportSection& section = report.add("Prediction and free simulation");
  for (const PredictionFigures& figure : judged.figures) add(section, "J." + steps_id(figure.steps), mean(figure.j));
  add(section, "rows", judged.figures.front().rows, "rows judged");
  section.tables.push_back(channel_table(subject, judged));
  add_plots(subject, judged, section);
  if (judged.tests) add_test_series(*judged.tests, subject.channels, section);
  if (!subject.options.responses) return report;
  add_error_growth(subject, section);
  add_responses({subject.arx, subject.channels, subject.recording.rate_hz}, false, report);
  return report;
}

}  // namespace
}  // namespace arx

Result<Report> validate_arx(const Model& model, const Recording& recording, const ValidationOptions& options,
                            const Progress& progress) {
  if (auto ok = check_steps(options.steps); !ok) return ok.error();
  const ChannelChoice channels = arx::channels_of(model);
  if (const auto found = arx::sources_of({&recording, 1}, channels); !found) return found.error();
  std::vector<double> moved;
  const Recording seen = arx::seen_by(model, recording, &moved);
  const auto& dynamics = std::get<ArxModel>(model.dynamics);
  const arx::Subject subject{model, dynamics, channels, seen, options, arx::error_sd(dynamics, options.steps), moved};
  const auto judged = arx::judge(subject, progress);
  if (!judged) return judged.error();
  return arx::report_of(subject, *judged);
}

}  // namespace wisp
