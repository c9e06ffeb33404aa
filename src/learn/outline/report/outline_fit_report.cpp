#include <cstdio>

#include "learn/arx/report/fit_report.hpp"
#include "learn/arx/report/report_values.hpp"
#include "learn/outline/report/outline_report.hpp"
#include "learn/outline/report/outline_report_parts.hpp"

namespace wisp {
namespace {

const char* criterion_name(OutlineCriterion by) {
  switch (by) {
    case OutlineCriterion::kGiven:
      return "given";
    case OutlineCriterion::kFpe:
      return "fpe";
    case OutlineCriterion::kHeldOutStep:
      return "held_out_step";
    case OutlineCriterion::kHeldOutFreeRun:
      return "held_out_free_run";
  }
  return "";
}

// What was learned from.
ReportSection data_section(const OutlineSummary& summary) {
  ReportSection section{"Data"};
  std::string names;
  ReportTable inputs{"inputs", "", {{"name", ""}, {"unit", ""}, {"scale", ""}}, {}};
  for (const OutlineInput& input : summary.inputs) {
    names += (names.empty() ? "" : ", ") + input.name;
    inputs.rows.push_back({input.name, input.unit, input.scale});
  }
  const char* judged = summary.inputs.empty() && summary.refitted ? "at a time: seconds in turn, until all are judged"
                                                                  : "what the figures below are judged on";
  section.entries = {{"rate_hz", summary.rate_hz, "rate", "frames a second"},
                     {"", names.empty() ? "none: a model of flicker" : names, "inputs", ""},
                     {"points", summary.points, "control points", ""},
                     {"samples.learned", summary.rows_learned, "frames to learn from", ""},
                     {"samples.held_out", summary.rows_held_out, "frames held out", "", {}, judged}};
  section.tables.push_back(std::move(inputs));
  add_alignment(summary.alignment, section);
  return section;
}

void add_ridge(const RidgeChoice& choice, ReportSection& section) {
  if (choice.reason.empty()) return;
  section.entries.push_back({"ridge.value", choice.ridge, "", ""});
  section.entries.push_back({"ridge.reason", choice.reason, "regularised by", ""});
  ReportTable candidates{"ridge.candidates", "", {{"ridge", ""}, {"held_out_error", ""}, {"stable", ""}}, {}};
  for (const RidgeCandidate& one : choice.candidates) candidates.rows.push_back({one.ridge, one.error, one.stable});
  section.tables.push_back(std::move(candidates));
}

// The structure of the equations, and how it was chosen.
ReportSection structure_section(const OutlineSummary& summary) {
  const OutlineChoice& choice = summary.choice;
  const bool searched = choice.by != OutlineCriterion::kGiven;
  ReportSection section{"Structure"};
  section.entries = {{"na", arx::list_of(summary.orders.na), "", ""},
                     {"nb", arx::list_of(summary.orders.nb), "", ""},
                     {"nk", arx::list_of(summary.orders.nk), "", ""},
                     {"order_and_delay.order", choice.taken().order, "order", ""},
                     {"order_and_delay.delay", choice.taken().delay, "delay", "frames"},
                     {"order_and_delay.by", criterion_name(choice.by), "", ""},
                     {"order_and_delay.reason", choice.reason, searched ? "chosen as" : "", ""}};
  ReportTable candidates{
      "order_and_delay.candidates", "", {{"order", ""}, {"delay", ""}, {"fpe", ""}, {"error", ""}}, {}};
  for (const OutlineCandidate& one : choice.candidates) {
    if (searched) candidates.rows.push_back({one.order, one.delay, one.fpe, one.error});
  }
  section.tables.push_back(std::move(candidates));
  add_ridge(summary.ridge, section);
  return section;
}

std::string curve_text(const InputCurve& curve) {
  std::string text;
  for (std::size_t k = 0; k < curve.at.size(); ++k) {
    char knot[64];
    std::snprintf(knot, sizeof knot, "%s%.3g → %.3g", k > 0 ? ", " : "", curve.at[k], curve.value[k]);
    text += knot;
  }
  return text;
}

ReportSection curve_section(const OutlineSummary& summary) {
  const CurveChoice& choice = summary.curve_choice;
  ReportSection section{"Input nonlinearity",
                        {{"input_curve.knots", choice.knots, "", ""},
                         {"input_curve.reason", choice.reason, choice.reason.empty() ? "" : "chosen as", ""}}};
  ReportTable candidates{
      "input_curve.candidates", "", {{"knots", ""}, {"held_out_gain", ""}, {"standard_errors", ""}}, {}};
  for (const CurveCandidate& one : choice.candidates) {
    candidates.rows.push_back({one.knots, one.gain, one.sureness});
  }
  ReportTable curves{"input_curve.curves", "", {{"input", ""}, {"at", ""}, {"value", ""}, {"std_error", ""}}, {}};
  for (std::size_t k = 0; k < summary.curves.size(); ++k) {
    const CurveEstimate& one = summary.curves[k];
    section.entries.push_back({"", curve_text(one.curve), "curve of " + summary.inputs[k].name, ""});
    curves.rows.push_back({summary.inputs[k].name, one.curve.at, one.curve.value, one.std_error});
  }
  section.tables = {std::move(candidates), std::move(curves)};
  return section;
}

ReportTable channels_table(const OutlineFit& fit) {
  const OutlineSummary& summary = fit.summary;
  ReportTable table{"channels", "", {{"name", ""}, {"residual_sd", ""}, {"residual_sd_ci95", ""}}, {}};
  add_step_columns("fit_percent", summary.learned.steps, table);
  if (summary.held_out) {
    add_step_columns("held_out_fit_percent", summary.held_out->steps, table);
  } else {
    table.columns.push_back({"held_out_fit_percent", ""});
  }
  for (std::size_t k = 0; k < fit.model.outputs.size(); ++k) {
    const OutlineResidual& residual = summary.residuals[k];
    std::vector<ReportValue> row{fit.model.outputs[k].name, residual.sd,
                                 ReportList{residual.sd_ci95[0], residual.sd_ci95[1]}};
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
    add_by_steps("tip.held_out_absolute_fit_percent", judged.steps, judged.tip_absolute_fit_percent, "", "%", section);
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

ReportSection model_section(const OutlineSummary& summary) {
  const ArxStability& stable = summary.stable;
  return {
      "Model",
      {{"fpe", summary.fpe, "final prediction error", ""},
       {"stable.radius", stable.radius, "spectral radius", "", {}, stable.changed ? "made stable" : ""},
       {"stable.changed", stable.changed, "", ""},
       {"stable.estimated_radius", stable.estimated, "", ""},
       {"stable.loss_factor", stable.loss_factor, "", ""},
       {"stable.moved_std_errors", stable.moved, "", ""},
       {"held_share", summary.held_share, "share of steps clamped", "", {}, "playing freely; at most 0.001 is good"}}};
}

}  // namespace

std::vector<ReportSection> report_sections(const OutlineFit& fit) {
  std::vector<ReportSection> sections = {data_section(fit.summary), structure_section(fit.summary),
                                         curve_section(fit.summary)};
  sections.push_back(fit_section(fit));
  sections.push_back(model_section(fit.summary));
  return sections;
}

}  // namespace wisp
