#include "base/statistics.hpp"
#include "learn/arx/report/fit_report.hpp"
#include "learn/arx/report/report_values.hpp"
#include "learn/outline/report/outline_report.hpp"
#include "learn/outline/report/outline_report_parts.hpp"

namespace wisp {
namespace {

// What was learned from.
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

// The structure of the equations.
ReportSection structure_section(const OutlineSummary& summary) {
  const OutlineDynamics& dynamics = summary.dynamics;
  const ShapeComponents& shape = dynamics.shape;
  const std::string text = shape.empty()
                               ? "one system a control point, as in the paper"
                               : std::to_string(shape.symmetric) + " symmetric and " +
                                     std::to_string(shape.antisymmetric) + " antisymmetric components of the shape";
  const std::string noise =
      summary.resampled_rows > 0 ? std::to_string(summary.resampled_rows) + " resampled residuals" : "Gaussian";
  return {"Structure",
          {{"na", arx::list_of(dynamics.arx.orders.na), "", ""},
           {"nb", arx::list_of(dynamics.arx.orders.nb), "", ""},
           {"nk", arx::list_of(dynamics.arx.orders.nk), "", ""},
           {"", text, "dynamics", ""},
           {"components.symmetric", shape.symmetric, "", ""},
           {"components.antisymmetric", shape.antisymmetric, "", ""},
           {"ridge", dynamics.ridge, "", ""},
           {"noise.rows", summary.resampled_rows, "", ""},
           {"", noise, "noise", ""}}};
}

ReportTable channels_table(const OutlineFit& fit) {
  const OutlineSummary& summary = fit.summary;
  ReportTable table{"channels", "", {{"name", ""}, {"residual_sd", ""}}, {}};
  add_step_columns("fit_percent", summary.learned.steps, table);
  if (summary.held_out) {
    add_step_columns("held_out_fit_percent", summary.held_out->steps, table);
  } else {
    table.columns.push_back({"held_out_fit_percent", ""});
  }
  for (std::size_t k = 0; k < fit.model.outputs.size(); ++k) {
    std::vector<ReportValue> row{fit.model.outputs[k].name, summary.residual_sd[k]};
    for (double value : summary.learned.channels[k].fit_percent) row.push_back(value);
    if (summary.held_out) {
      for (double value : summary.held_out->channels[k].fit_percent) row.push_back(value);
    } else {
      row.emplace_back();
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

// How well the outline is followed.
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
  add_by_steps("J", judged.steps, mean_per_step(judged.j), "", "", section);
  for (std::size_t k = 0; k < judged.steps.size(); ++k) {
    section.entries.push_back({"J_per_point." + step_id(judged.steps[k]), judged.j[k], "", ""});
  }
  section.tables.push_back(channels_table(fit));
  return section;
}

// What is seen of free play.
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
  const auto add = [&](const char* id, const char* label, const std::optional<Bounded>& distance) {
    if (!distance) return;
    section.entries.push_back({std::string(id) + ".value", distance->value, label, ""});
    section.entries.push_back({std::string(id) + ".floor", distance->floor, "", ""});
    section.entries.push_back({std::string(id) + ".ceiling", distance->ceiling, "", ""});
  };
  add("play.half_second", "energy distance over half a second", trial.half_second);
  add("play.two_seconds", "energy distance over two seconds", trial.two_seconds);
  return section;
}

}  // namespace

std::vector<ReportSection> report_sections(const OutlineFit& fit) {
  return {data_section(fit.summary), structure_section(fit.summary), fit_section(fit), play_section(fit.summary)};
}

}  // namespace wisp
