#include "learn/outline/report/outline_report.hpp"

#include <cmath>

#include "base/statistics.hpp"
#include "learn/judge/prediction.hpp"
#include "learn/outline/outline_alignment.hpp"
#include "learn/report/fit_report.hpp"
#include "learn/report/report_values.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace {

std::string horizon(int steps) {
  if (steps == kFreeRun) return "simulated freely";
  return steps == 1 ? "next frame" : std::to_string(steps) + " frames ahead";
}

// Adds an entry ID.STEPS per number of steps. Entries with a label are shown to people, labelled with the horizon too.
void add_by_steps(const std::string& id, const std::vector<int>& steps, const std::vector<double>& values,
                  const std::string& label, const std::string& unit, ReportSection& section) {
  for (std::size_t k = 0; k < steps.size() && k < values.size(); ++k) {
    section.entries.push_back({id + "." + arx::steps_id(steps[k]), values[k],
                               label.empty() ? label : label + ", " + horizon(steps[k]), unit});
  }
}

// Adds `alignment` [{recording, input, motion, offset_seconds, …}] and, for people, a sentence for each.
void add_alignment(const std::vector<InputAlignment>& alignment, ReportSection& section) {
  ReportTable table{"alignment",
                    "",
                    {{"recording", ""},
                     {"input", ""},
                     {"motion", ""},
                     {"offset_seconds", ""},
                     {"offset_ci95", ""},
                     {"usable", ""},
                     {"reason", ""},
                     {"frames_moved", ""}},
                    {}};
  for (const InputAlignment& one : alignment) {
    section.entries.push_back({"", one.note(), "timing", ""});
    table.rows.push_back({one.source, one.input, one.motion, one.found.offset_seconds,
                          ReportList{one.found.low_seconds, one.found.high_seconds}, one.found.usable, one.found.reason,
                          one.frames_moved});
  }
  section.tables.push_back(std::move(table));
}

ReportSection data_section(const OutlineSummary& summary) {
  ReportSection section{"Data"};
  std::string names;
  ReportTable inputs{"inputs", "", {{"name", ""}, {"unit", ""}, {"scale", ""}}, {}};
  for (const OutlineInput& input : summary.inputs) {
    names += (names.empty() ? "" : ", ") + input.name;
    inputs.rows.push_back({input.name, input.unit, input.scale});
  }
  section.entries = {
      {"rate_hz", summary.rate_hz, "rate", "frames a second"},
      {"", names.empty() ? "none: a model of flicker" : names, "inputs", ""},
      {"points", summary.points, "control points", ""},
      {"samples.learned", summary.rows_learned, "frames to learn from", ""},
      {"samples.held_out", summary.rows_held_out, "frames held out", "", {}, "what the fit is judged on"}};
  section.tables.push_back(std::move(inputs));
  add_alignment(summary.alignment, section);
  return section;
}

ReportSection structure_section(const OutlineSummary& summary) {
  const OutlineDynamics& dynamics = summary.dynamics;
  const ShapeComponents& shape = dynamics.shape;
  const std::string text = shape.empty()
                               ? "one system a control point, as in the paper"
                               : std::to_string(shape.symmetric) + " symmetric and " +
                                     std::to_string(shape.antisymmetric) + " antisymmetric components of the shape";
  const std::string noise =
      summary.resampled_rows > 0 ? std::to_string(summary.resampled_rows) + " resampled residuals" : "Gaussian";
  ReportSection section{"Structure"};
  arx::add_orders(dynamics.arx.orders, "", section);
  arx::add_line(section, "dynamics", text);
  arx::add_all(section, "", "components.symmetric", shape.symmetric, "components.antisymmetric", shape.antisymmetric,
               "ridge", dynamics.ridge, "noise.rows", summary.resampled_rows);
  arx::add_line(section, "noise", noise);
  return section;
}

ReportSection fit_section(const OutlineFit& fit) {
  const OutlineSummary& summary = fit.summary;
  const bool held_out = summary.held_out.has_value();
  const OutlineFigures& judged = held_out ? *summary.held_out : summary.learned;
  ReportSection section{held_out ? "Fit to held-out frames" : "Fit to the frames learned from"};
  add_by_steps("tip.fit_percent", summary.learned.steps, summary.learned.tip_fit_percent, held_out ? "" : "tip fit",
               "%", section);
  if (held_out) {
    add_by_steps("tip.held_out_fit_percent", judged.steps, judged.tip_fit_percent, "tip fit", "%", section);
  } else {
    section.entries.push_back({"tip.held_out_fit_percent", {}, "", ""});
  }
  section.entries.push_back({"overlap", at_steps(judged.steps, judged.overlap, kFreeRun), "", ""});
  add_by_steps("overlap_by_steps", judged.steps, judged.overlap, "outline overlap", "", section);
  add_by_steps("J", judged.steps, judged.j, "", "", section);
  return section;
}

void add_bounded(const std::string& id, const Bounded& measure, const std::string& label, const std::string& unit,
                 const std::string& meaning, ReportSection& section) {
  arx::add(section, id + ".value", measure.value, label, unit, meaning);
  arx::add_all(section, id + ".", "floor", measure.floor, "ceiling", measure.ceiling);
}

ReportSection play_section(const OutlineSummary& summary) {
  const OutlineTrial& trial = summary.trial;
  ReportSection section{
      "Free play beside the recording",
      {{"stable.radius", summary.radius, "spectral radius", "", {}, summary.dynamics.stabilised ? "made stable" : ""},
       {"stable.changed", summary.dynamics.stabilised, "", ""},
       {"spread", median(trial.sd_ratio), "spread, played over recorded", "", {}, "0.8 to 1.25 is good"},
       {"outside_share", trial.outside, "shapes that the recording has not", "", {}, "at most 0.03 is good"},
       {"crossed_share", trial.crossed, "outlines that cross themselves", ""},
       {"crossed_share_recorded", trial.crossed_recorded, "", ""},
       {"held_share", trial.held_share, "share of steps clamped", "", {}, "at most 0.001 is good"}}};
  if (trial.half_second) {
    add_bounded("play.half_second", *trial.half_second, "energy distance over half a second", "", "", section);
  }
  if (trial.two_seconds) {
    add_bounded("play.two_seconds", *trial.two_seconds, "energy distance over two seconds", "", "", section);
  }
  return section;
}

ReportSection fit_section(const OutlineJudgement& found) {
  const OutlineFigures& figures = found.figures;
  ReportSection section{"Prediction and simulation", {{"rows", figures.rows, "frames judged", ""}}};
  add_alignment(found.alignment, section);
  add_by_steps("J", figures.steps, figures.j, "", "", section);
  add_by_steps("tip.fit_percent", figures.steps, figures.tip_fit_percent, "tip fit", "%", section);
  section.entries.push_back({"overlap", at_steps(figures.steps, figures.overlap, kFreeRun), "", ""});
  add_by_steps("overlap_by_steps", figures.steps, figures.overlap, "outline overlap", "", section);
  return section;
}

// Describes the floor and the ceiling of a measure in words.
std::string between(const Bounded& measure) {
  const auto bound = [](double value) { return std::isfinite(value) ? number_text(value, 3) : "too short to tell"; };
  return "two halves of the recording: " + bound(measure.floor) + ", shuffled frames: " + bound(measure.ceiling);
}

ReportSection fidelity_section(const OutlineJudgement& found) {
  ReportSection section{"Fidelity of free play"};
  if (!found.fidelity) {
    section.entries.push_back({"fidelity", {}, "", ""});
  } else {
    const Fidelity& figures = *found.fidelity;
    const auto add = [&](const char* id, const Bounded& measure, const char* label, const char* unit = "") {
      add_bounded(std::string("fidelity.") + id, measure, label, unit, between(measure), section);
    };
    add("log_spectral_distance", figures.log_spectral_distance, "log-spectral distance", "dB");
    add("energy_distance", figures.energy_distance, "normalised energy distance over half a second");
    add("two_seconds.energy_distance", figures.long_motion, "the same over two seconds");
    add("two_seconds.spectral_distance", figures.long_spectra, "of log spectra over two seconds");
    add("tails", figures.tails, "violence of the rarest motion, |ln| of its ratio");
    section.entries.push_back({"fidelity.verbatim_seconds", figures.verbatim_seconds, "", ""});
  }
  section.entries.push_back({"held_share", found.held_share, "share of steps clamped", ""});
  section.entries.push_back({"crossed_share", found.self_intersection_rate, "self-intersection rate", ""});
  return section;
}

}  // namespace

std::vector<ReportSection> report_sections(const OutlineFit& fit) {
  return {data_section(fit.summary), structure_section(fit.summary), fit_section(fit), play_section(fit.summary)};
}

std::vector<ReportSection> report_sections(const OutlineJudgement& found) {
  return {fit_section(found), fidelity_section(found)};
}

}  // namespace wisp
