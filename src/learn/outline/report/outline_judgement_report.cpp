#include <cmath>
#include <cstdio>
#include <string>

#include "learn/outline/report/outline_report.hpp"
#include "learn/outline/report/outline_report_parts.hpp"

namespace wisp {
namespace {

ReportTable channels_table(const OutlineFigures& figures) {
  ReportTable table{"channels", "", {{"name", ""}}, {}};
  add_step_columns("fit_percent", figures.steps, table);
  for (const OutlineChannelFigures& channel : figures.channels) {
    std::vector<ReportValue> row{channel.name};
    for (double value : channel.fit_percent) row.push_back(value);
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportTable points_table(const OutlineFigures& figures) {
  ReportTable table{"points", "", {}, {}};
  add_step_columns("fit_percent", figures.steps, table);
  add_step_columns("J", figures.steps, table);
  for (std::size_t p = 0; !figures.j.empty() && p < figures.j.front().size(); ++p) {
    std::vector<ReportValue> row;
    for (const auto& fits : figures.point_fit_percent) row.push_back(fits[p]);
    for (const auto& errors : figures.j) row.push_back(errors[p]);
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportSection fit_section(const OutlineJudgement& found) {
  const OutlineFigures& figures = found.figures;
  ReportSection section{"Prediction and simulation", {{"rows", figures.rows, "frames judged", ""}}};
  add_alignment(found.alignment, section);
  add_by_steps("J", figures.steps, mean_per_step(figures.j), "", "", section);
  add_by_steps("tip.fit_percent", figures.steps, figures.tip_fit_percent, "tip fit", "%", section);
  section.entries.push_back({"overlap", at_steps(figures.steps, figures.overlap, kFreeRun), "", ""});
  add_by_steps("overlap_by_steps", figures.steps, figures.overlap, "outline overlap", "", section);
  section.tables.push_back(channels_table(figures));
  section.tables.push_back(points_table(figures));
  return section;
}

void add_bounded(const std::string& id, const Bounded& measure, const std::string& label, const std::string& unit,
                 ReportSection& section) {
  const auto bound = [](double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return std::isfinite(value) ? std::string(text) : std::string("too short to tell");
  };
  const std::string meaning =
      "two halves of the recording: " + bound(measure.floor) + ", shuffled frames: " + bound(measure.ceiling);
  section.entries.push_back({id + ".value", measure.value, label, unit, {}, meaning});
  section.entries.push_back({id + ".floor", measure.floor, "", ""});
  section.entries.push_back({id + ".ceiling", measure.ceiling, "", ""});
}

ReportSection fidelity_section(const OutlineJudgement& found) {
  ReportSection section{"Fidelity of free play"};
  if (!found.fidelity) {
    section.entries.push_back({"fidelity", {}, "", ""});
  } else {
    const Fidelity& figures = *found.fidelity;
    add_bounded("fidelity.log_spectral_distance", figures.log_spectral_distance, "log-spectral distance", "dB",
                section);
    add_bounded("fidelity.energy_distance", figures.energy_distance, "normalised energy distance over half a second",
                "", section);
    add_bounded("fidelity.two_seconds.energy_distance", figures.long_motion, "the same over two seconds", "", section);
    add_bounded("fidelity.two_seconds.spectral_distance", figures.long_spectra, "of log spectra over two seconds", "",
                section);
    add_bounded("fidelity.tails", figures.tails, "violence of the rarest motion, |ln| of its ratio", "", section);
    section.entries.push_back({"fidelity.verbatim_seconds", figures.verbatim_seconds, "", ""});
    const char* bounded = "log_spectral_distance";
    ReportTable channels{"fidelity.channels", "", {{"name", ""}, {"sd_real", ""}, {"sd_synthesized", ""}}, {}};
    for (const char* bound : {".value", ".floor", ".ceiling"})
      channels.columns.push_back({std::string(bounded) + bound, ""});
    for (const ChannelFidelity& one : figures.channels) {
      const Bounded& distance = one.log_spectral_distance;
      channels.rows.push_back(
          {one.name, one.sd_real, one.sd_synthesized, distance.value, distance.floor, distance.ceiling});
    }
    section.tables.push_back(std::move(channels));
  }
  section.entries.push_back({"held_share", found.held_share, "share of steps clamped", ""});
  section.entries.push_back({"crossed_share", found.self_intersection_rate, "self-intersection rate", ""});
  return section;
}

}  // namespace

std::vector<ReportSection> report_sections(const OutlineJudgement& found) {
  return {fit_section(found), fidelity_section(found)};
}

}  // namespace wisp
