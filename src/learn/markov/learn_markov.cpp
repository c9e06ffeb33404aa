#include "learn/markov/learn_markov.hpp"

#include <cmath>

#include "base/statistics.hpp"
#include "learn/arx/learn_arx.hpp"
#include "learn/markov/markov_rows.hpp"
#include "learn/report/fit_report.hpp"
#include "learn/report/report_values.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace markov {
namespace {

using arx::add;
using arx::add_line;

Training training_of(const Fitted& fitted, const SwitchedRecipe& recipe, Training training) {
  const Summary& summary = fitted.summary;
  training.recipe = arx::order_notes(fitted.model.orders, recipe.coupling);
  training.recipe.push_back({"modes", recipe.modes ? std::to_string(*recipe.modes) : "auto"});
  training.figures = {{"samples_used", static_cast<double>(summary.samples_used)},
                      {"held_out", static_cast<double>(summary.held_out)}};
  for (const Candidate& one : summary.candidates) {
    training.figures.push_back({"held_out_log_likelihood_" + std::to_string(one.modes), one.held_out_log_likelihood});
  }
  training.usable = summary.usable;
  return training;
}

// Adds the numbers of modes that were tried, and the number of rows in which each mode acts.
void add_modes(const Fitted& fitted, ReportSection& section) {
  ReportTable tried{"candidates",
                    "numbers of modes that were tried",
                    {{"modes", "modes"},
                     {"log_likelihood", ""},
                     {"held_out_log_likelihood", "held out", "nats a row"},
                     {"gain_std_error", "gain ± standard error"},
                     {"determined", "enough rows"}},
                    {}};
  const Summary& summary = fitted.summary;
  for (const Candidate& one : summary.candidates) {
    tried.rows.push_back(
        {one.modes, one.log_likelihood, one.held_out_log_likelihood, one.gain_std_error, one.determined});
  }
  section.tables.push_back(std::move(tried));
  for (std::size_t k = 0; k < summary.mode_rows.size(); ++k) {
    add_line(section, "mode " + std::to_string(k), summary.mode_rows[k],
             "rows, spectral radius " + number_text(spectral_radius(mode_model(fitted.model, k)), 5) +
                 (summary.mode_changed[k] ? ", made stable" : ""));
  }
  add(section, "mode_rows", ReportList(summary.mode_rows.begin(), summary.mode_rows.end()));
}

void add_fit(const Fitted& fitted, const Model& model, Report& report) {
  const Summary& summary = fitted.summary;
  report.verdict = ReportVerdict{summary.usable.verdict, summary.usable.reason};
  for (std::size_t k = 0; k < fitted.model.modes.size(); ++k) {
    const std::string mode = "mode " + std::to_string(k);
    if (summary.mode_changed[k]) report.warnings.push_back(mode + " was made stable");
    const std::size_t first = report.sections.size();
    arx::tell(mode_model(fitted.model, k), model, report);
    for (std::size_t s = first; s < report.sections.size(); ++s) {
      report.sections[s].title = "M" + mode.substr(1) + ": " + report.sections[s].title;
    }
  }
  ReportSection& section = report.add("Fit");
  describe(fitted.model, "", section);
  add(section, "samples_used", summary.samples_used, "rows learned from");
  add(section, "held_out", summary.held_out);
  add(section, "fit_percent.1", summary.fit_percent, "fit one step ahead", "%");
  if (!summary.free_run_fit_percent.empty()) {
    add(section, "fit_percent.inf", summary.free_run_fit_percent, "fit of free simulation", "%");
  }
  add_modes(fitted, section);
}

ReportTable channel_table(const std::vector<PredictionFigures>& figures, const ChannelChoice& channels) {
  ReportTable table{"channels", "every output", {{"name", "output"}}, {}};
  for (const std::string& output : channels.outputs) table.rows.push_back({output});
  for (const PredictionFigures& figure : figures) {
    const std::string id = arx::steps_id(figure.steps), ahead = figure.steps == kFreeRun ? "free" : id + " ahead";
    arx::add_column(table, {"fit_percent." + id, "fit " + ahead, "%"},
                    [&](std::size_t i) { return figure.fit_percent[i]; });
    arx::add_column(table, {"rms_error." + id, "RMS error " + ahead},
                    [&](std::size_t i) { return std::sqrt(figure.mean_square[i]); });
  }
  return table;
}

}  // namespace

void describe(const SwitchedArxModel& model, const std::string& prefix, ReportSection& section) {
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
  section.tables.push_back(std::move(table));
  add(section, prefix + "initial", model.initial);
  add(section, prefix + "transitions", arx::matrix_of(model.transitions, model.modes.size()));
}

}  // namespace markov

Result<Fit> learn_switched(std::span<const Recording> recordings, const SwitchedRecipe& recipe,
                           const Progress& progress) {
  if (auto ok = check_fields(recipe); !ok) return ok.error();
  const ChannelChoice channels{recipe.inputs, recipe.outputs};
  const auto sources = arx::sources_of(recordings, channels);
  if (!sources) return sources.error();
  const auto orders = arx::orders_of(recipe.na, recipe.nb, recipe.nk, recipe.coupling, channels);
  if (!orders) return orders.error();
  const auto fitted = markov::fit(
      recordings, channels, {.orders = *orders, .modes = recipe.modes.value_or(0), .seed = recipe.seed}, progress);
  if (!fitted) return fitted.error();
  Fit fit{arx::plain_model(recipe.name, channels, *sources), {}};
  fit.model.dynamics = fitted->model;
  fit.model.training = markov::training_of(*fitted, recipe, std::move(fit.model.training));
  markov::add_fit(*fitted, fit.model, fit.report);
  arx::add(fit.report.sections.back(), "seed", static_cast<std::int64_t>(recipe.seed));
  return fit;
}

Result<Report> validate_switched(const Model& model, const Recording& recording, const ValidationOptions& options,
                                 const Progress& progress) {
  const auto& dynamics = std::get<SwitchedArxModel>(model.dynamics);
  const ChannelChoice channels = arx::channels_of(model);
  if (options.steps.empty()) return Error{"no number of steps was requested"};
  if (auto ok = arx::check_progress(progress, "predicting", 0); !ok) return ok.error();
  Report report;
  ReportSection& section = report.add("Prediction and free simulation");
  std::vector<PredictionFigures> figures;
  for (const int steps : options.steps) {
    auto one = markov::figures(dynamics, {&recording, 1}, channels, steps);
    if (!one) return one.error();
    arx::add(section, "J." + arx::steps_id(steps), mean(one->j));
    figures.push_back(std::move(*one));
  }
  if (auto ok = arx::check_progress(progress, "judging modes", 0.5); !ok) return ok.error();
  const auto belief = markov::believe(dynamics, recording, channels);
  if (!belief) return belief.error();
  std::vector<std::size_t> acted(dynamics.modes.size(), 0);
  for (const int mode : belief->likeliest()) ++acted[static_cast<std::size_t>(mode)];
  arx::add(section, "rows", figures.front().rows, "rows judged");
  arx::add(section, "mode_rows", ReportList(acted.begin(), acted.end()), "rows in which each mode acts");
  arx::add(section, "log_likelihood", belief->log_likelihood.mean(), "log-likelihood", "nats a row");
  section.tables.push_back(markov::channel_table(figures, channels));
  return report;
}

}  // namespace wisp
