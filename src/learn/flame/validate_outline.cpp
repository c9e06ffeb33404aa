#include "wisp/learn/validate.hpp"

#include <cmath>

#include "learn/flame/extinction_learning.hpp"
#include "learn/numeric/spectrum.hpp"
#include "learn/outline/outline_inputs.hpp"
#include "learn/outline/outline_shape.hpp"
#include "learn/outline/report/outline_report.hpp"
#include "learn/report/fit_report.hpp"
#include "record/verdict.hpp"

namespace wisp {
namespace {

constexpr double kSameGain = 0.02;  // factors closer to 1 than this are not reported

// Returns the predictions for pictures: with inputs the free simulation, without inputs the last prediction at most
// five frames ahead. If there is none, returns the first of all predictions.
const PredictedOutlines& shown(const OutlineJudgement& found) {
  constexpr int kLookAhead = 5;
  const PredictedOutlines* best = &found.predicted.front();
  for (const PredictedOutlines& predicted : found.predicted) {
    if (found.driven) {
      if (predicted.steps == kFreeRun) return predicted;
    } else if (predicted.steps != kFreeRun && predicted.steps <= kLookAhead) {
      best = &predicted;
    }
  }
  return *best;
}

std::string label_of(const PredictedOutlines& predicted) {
  if (predicted.steps == kFreeRun) return "simulated from the input alone";
  return "predicted " + std::to_string(predicted.steps) + (predicted.steps == 1 ? " frame ahead" : " frames ahead");
}

// The tip's position relative to the base, in the model's units, per row: x (0) or y (1); NaN where missing.
std::vector<double> tips(const OutlineRows& rows, double pixels_per_unit, std::size_t coordinate) {
  std::vector<double> values;
  const double unit = coordinate == 0 ? pixels_per_unit : -pixels_per_unit;
  for (const auto& outline : rows) {
    values.push_back(std::nan(""));
    if (outline.empty()) continue;
    const double base = (outline.front()[coordinate] + outline.back()[coordinate]) / 2;
    values.back() = (tip_of(outline)[coordinate] - base) / unit;
  }
  return values;
}

ReportSection tip_series(const ValidatedOutline& out, const std::vector<double>& seconds) {
  ReportSection section{"Tip, sideways"};
  const auto add = [&](const char* id, const std::string& label, const OutlineRows& rows) {
    section.series.push_back({id, label, "seconds", "flame heights", seconds, tips(rows, out.pixels_per_unit, 0)});
  };
  add("tip.captured", "captured", out.captured);
  add("tip.simulated", out.simulated_label, out.simulated);
  return section;
}

// Series of an input. The unit "1" of wind from sound is labelled as a strong gust.
ReportSection input_series(const Channel& input, const std::vector<double>& seconds) {
  const std::string unit = input.unit == "1" ? "1: a strong gust" : input.unit;
  return {input.name, {}, {}, {{"input." + input.name, "", "seconds", unit, seconds, input.samples}}};
}

ReportSection flicker_series(const ValidatedOutline& out, double rate_hz, std::size_t welch_samples,
                             std::size_t coordinate) {
  ReportSection section{coordinate == 0 ? "Flicker of the tip, sideways" : "Flicker of the tip, up and down"};
  const auto add = [&](const std::string& label, const OutlineRows& rows) {
    const std::vector<std::vector<double>> stretches = whole_stretches(tips(rows, out.pixels_per_unit, coordinate));
    const Spectrum spectrum = welch(stretches, rate_hz, welch_samples);
    section.series.push_back({std::string("flicker.") + (coordinate == 0 ? "x." : "y.") + label, label, "Hz",
                              "power density", spectrum.frequency_hz, spectrum.power});
  };
  add("captured", out.captured);
  add("synthesized", out.played);
  return section;
}

void add_series(const Recording& recording, const OutlineJudgement& found, ValidatedOutline& out) {
  const std::vector<double> seconds = seconds_of(recording);
  auto& sections = out.report.sections;
  sections.push_back(tip_series(out, seconds));
  for (std::size_t channel : channels_with_role(recording, Role::kInput)) {
    sections.push_back(input_series(recording.channels[channel], seconds));
  }
  const std::size_t welch_samples = found.fidelity ? found.fidelity->welch_samples : 64;
  for (std::size_t coordinate : {0, 1}) {
    sections.push_back(flicker_series(out, recording.rate_hz, welch_samples, coordinate));
  }
}

// Reports the input's gain, since another microphone measures the same wind at another level.
ReportSection gain_section(double factor) {
  ReportSection section{"", {{"gain", factor, "", ""}}};
  if (std::abs(factor - 1) < kSameGain) return section;
  section.entries[0].label = "wind of this recording, times";
  section.entries[0].meaning =
      "as the training's microphone would call it; with per-recording gain (--own-gain) where another one heard it";
  return section;
}

Result<void> add_outlines(const Recording& recording, const OutlineJudgement& found, ValidatedOutline& out) {
  for (const auto& [from, to] : {std::pair(&recording, &out.captured),
                                 {&shown(found).recording, &out.simulated},
                                 {&found.played, &out.played}}) {
    auto rows = outline_rows(*from);
    if (!rows) return rows.error();
    *to = *std::move(rows);
  }
  out.simulated_label = label_of(shown(found));
  out.pixels_per_unit = found.pixels_per_unit;
  return {};
}

}  // namespace

Result<OutlineRows> outline_rows(const Recording& recording) {
  const auto layout = outline_layout(recording);
  if (!layout) return layout.error();
  const OutlineCurve curve(layout->knots);
  OutlineRows rows;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    const auto control = whole_row(recording, *layout, row);
    rows.push_back(control.empty() ? std::vector<OutlinePoint>() : curve.polyline(control));
  }
  return rows;
}

Result<ValidatedOutline> validate_outline(const Model& model, const Recording& recording,
                                          const ValidationOptions& options, const Progress& progress) {
  constexpr FieldTraits kPlayed{.lowest = 1e-3, .highest = 86400};
  if (options.steps.empty()) return Error{"steps: there are none, expected at least one number of steps to judge"};
  if (auto ok = check_number("play_seconds", options.play_seconds, kPlayed); !ok) return ok.error();
  const auto factor = options.own_input_scale ? Result<double>(1.0) : factor_to_trained_gain(model, recording);
  if (!factor) return factor.error();
  const auto heard = options.own_input_scale ? Result<Recording>(recording) : at_trained_gain(model, recording);
  if (!heard) return heard.error();
  const auto burning = burning_part(model, *heard);
  if (!burning) return burning.error();
  const auto found = judge_outline(model, *burning, options, progress);
  if (!found) return found.error();
  const auto extinction = judge_extinction(model, *heard, options.own_input_scale);
  if (!extinction) return extinction.error();
  ValidatedOutline out;
  if (auto ok = add_outlines(*heard, *found, out); !ok) return ok.error();
  out.report.warnings = found->warnings;
  if (const auto why = refused_by_capture({&recording, 1})) out.report.warnings.push_back(*why);
  out.report.sections = report_sections(*found);
  out.report.sections.push_back(gain_section(*factor));
  out.report.sections.push_back(extinction_section(*extinction));
  add_series(*heard, *found, out);
  if (options.responses) arx::add_poles(std::get<ArxModel>(model.dynamics), out.report);
  return out;
}

}  // namespace wisp
