#include "learn/switched/switched_report.hpp"

#include "learn/arx/report/arx_description.hpp"
#include "learn/arx/report/report_values.hpp"
#include "learn/switched/learn_switched.hpp"
#include "record/number_text.hpp"

namespace wisp::switched {
namespace {

using arx::add;
using arx::add_line;

ReportTable modes_of(const SwitchedArxModel& model, const std::string& prefix) {
  ReportTable table{prefix + "modes", "", {{"A", ""}, {"B", ""}, {"constant", ""}, {"shock", ""}, {"radius", ""}}, {}};
  const bool errors = !model.modes.empty() && !model.modes.front().std_error.empty();
  if (errors) table.columns.insert(table.columns.end(), {{"std_error.A", ""}, {"std_error.B", ""}});
  for (std::size_t k = 0; k < model.modes.size(); ++k) {
    const ArxMode& mode = model.modes[k];
    auto theta = arx::lists_of(model.orders, mode.theta);
    auto& row = table.rows.emplace_back();
    row = {std::move(theta.a), std::move(theta.b), mode.constant, arx::matrix_of(mode.shock, mode.constant.size()),
           spectral_radius(mode_model(model, k))};
    if (!errors) continue;
    auto std_error = arx::lists_of(model.orders, mode.std_error);
    row.push_back(std::move(std_error.a));
    row.push_back(std::move(std_error.b));
  }
  return table;
}

std::string name_of(const RegionSample& sample) {
  return (sample.input ? "u" : "y") + std::to_string(sample.channel) + "(t-" + std::to_string(sample.lag) + ")";
}

// How many modes were tried, and which of them act.
void add_modes(const SwitchedSummary& summary, ReportSection& section) {
  ReportTable tried{"candidates",
                    "numbers of modes that were tried",
                    {{"modes", "modes"},
                     {"log_likelihood", ""},
                     {"held_out_log_likelihood", "held out", "nats a row"},
                     {"gain_std_error", "gain ± standard error"},
                     {"determined", "enough rows"}},
                    {}};
  for (const SwitchedCandidate& one : summary.candidates) {
    tried.rows.push_back(
        {one.modes, one.log_likelihood, one.held_out_log_likelihood, one.gain_std_error, one.determined});
  }
  section.tables.push_back(std::move(tried));
  for (std::size_t k = 0; k < summary.mode_rows.size(); ++k) {
    add_line(section, "mode " + std::to_string(k), summary.mode_rows[k],
             "rows, spectral radius " + number_text(summary.mode_radius[k], 5) +
                 (summary.mode_changed[k] ? ", made stable" : ""));
  }
  ReportList changed;
  for (bool one : summary.mode_changed) changed.push_back(one);
  add(section, "mode_rows", ReportList(summary.mode_rows.begin(), summary.mode_rows.end()));
  add(section, "mode_changed", std::move(changed));
}

void add_differences(const std::vector<ModeDifference>& differences, ReportSection& section) {
  ReportTable table{
      "mode_differences",
      "",
      {{"modes", ""}, {"coefficients", ""}, {"compared", ""}, {"most_std_errors", ""}, {"noise_ratio", ""}},
      {}};
  for (const ModeDifference& pair : differences) {
    table.rows.push_back({ReportList{pair.first, pair.second}, pair.coefficients, pair.compared, pair.most_std_errors,
                          pair.noise_ratio});
    add_line(section, "modes " + std::to_string(pair.first) + " and " + std::to_string(pair.second),
             (pair.same_coefficients()
                  ? "differ in the size of their noise alone: no coefficient by more than 3 standard errors"
                  : "differ in " + std::to_string(pair.coefficients) + " of " + std::to_string(pair.compared) +
                        " coefficients by more than 3 standard errors") +
                 ", noise " + number_text(pair.noise_ratio, 2) + " times as large");
  }
  section.tables.push_back(std::move(table));
}

}  // namespace

void describe(const SwitchedArxModel& model, const std::string& prefix, ReportSection& section) {
  section.tables.push_back(modes_of(model, prefix));
  if (model.switching == Switching::kRegions) {
    ReportList columns{"1"};
    for (const RegionSample& sample : region_samples(model.orders)) columns.push_back(name_of(sample));
    add(section, prefix + "region_columns", std::move(columns));
    add(section, prefix + "regions", arx::matrix_of(model.regions, model.modes.size()));
  } else {
    add(section, prefix + "initial", model.initial);
    add(section, prefix + "transitions", arx::matrix_of(model.transitions, model.modes.size()));
  }
  const bool found = !model.lyapunov.empty();
  add(section, prefix + "lyapunov", found);
  add(section, prefix + "bounded_by",
      found ? "a common Lyapunov function: no order of the modes makes it diverge"
            : "the range that outputs are clamped to: no common Lyapunov function was found",
      "bounded by");
}

void add_fit(const SwitchedFit& fit, const Model& model, Report& report) {
  const SwitchedSummary& summary = fit.summary;
  report.verdict = ReportVerdict{summary.usable.verdict, summary.usable.reason};
  report.warnings = summary.warnings;
  for (std::size_t k = 0; k < fit.model.modes.size(); ++k) {
    const std::size_t first = report.sections.size();
    arx::tell(mode_model(fit.model, k), model, report);
    for (std::size_t s = first; s < report.sections.size(); ++s) {
      report.sections[s].title = "Mode " + std::to_string(k) + ": " + report.sections[s].title;
    }
  }
  ReportSection& section = report.add("Fit");
  add(section, "switching", fit.model.switching == Switching::kMarkov ? "markov" : "regions", "switched by");
  describe(fit.model, "", section);
  add(section, "samples_used", summary.samples_used, "rows learned from");
  add(section, "held_out", summary.held_out);
  add(section, "fit_percent.1", summary.fit_percent, "fit one step ahead", "%");
  if (!summary.free_run_fit_percent.empty()) {
    add(section, "fit_percent.inf", summary.free_run_fit_percent, "fit of free simulation", "%");
  }
  add_modes(summary, section);
  add_differences(summary.differences, section);
}

}  // namespace wisp::switched
