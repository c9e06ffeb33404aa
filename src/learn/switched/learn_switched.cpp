#include "learn/switched/learn_switched.hpp"

#include <cmath>

#include "learn/arx/learn_arx.hpp"
#include "learn/arx/report/report_values.hpp"
#include "learn/switched/switched_fit.hpp"
#include "learn/switched/switched_prediction.hpp"
#include "learn/switched/switched_report.hpp"

namespace wisp {
namespace switched {
namespace {

SwitchedOptions options_of(const SwitchedRecipe& recipe, const ArxOrders& orders) {
  return {.orders = orders,
          .switching = recipe.switching,
          .modes = recipe.modes.value_or(0),
          .max_modes = recipe.max_modes,
          .subtract_means = recipe.subtract_means,
          .holdout = recipe.holdout,
          .seed = recipe.seed};
}

Training training_of(const SwitchedFit& fit, const SwitchedRecipe& recipe, Training training) {
  training.recipe = arx::order_notes(fit.model.orders, recipe.coupling);
  training.recipe.push_back({"offset", recipe.subtract_means ? "mean" : "none"});
  training.recipe.push_back({"modes", recipe.modes ? std::to_string(*recipe.modes) : "auto"});
  training.recipe.push_back({"switching", recipe.switching == Switching::kMarkov ? "markov" : "regions"});
  training.figures = {{"samples_used", static_cast<double>(fit.summary.samples_used)},
                      {"held_out", static_cast<double>(fit.summary.held_out)}};
  for (const SwitchedCandidate& candidate : fit.summary.candidates) {
    training.figures.push_back(
        {"held_out_log_likelihood_" + std::to_string(candidate.modes), candidate.held_out_log_likelihood});
  }
  training.usable = fit.summary.usable;
  return training;
}

ReportTable channel_table(const std::vector<PredictionFigures>& figures, const ChannelChoice& channels) {
  ReportTable table{"channels", "every output", {{"name", "output"}}, {}};
  for (const PredictionFigures& figure : figures) {
    const std::string id = arx::steps_id(figure.steps), ahead = figure.steps == kFreeRun ? "free" : id + " ahead";
    table.columns.push_back({"fit_percent." + id, "fit " + ahead, "%"});
    table.columns.push_back({"rms_error." + id, "RMS error " + ahead});
  }
  for (std::size_t i = 0; i < channels.outputs.size(); ++i) {
    auto& row = table.rows.emplace_back();
    row.emplace_back(channels.outputs[i]);
    for (const PredictionFigures& figure : figures) {
      row.emplace_back(figure.fit_percent[i]);
      row.emplace_back(std::sqrt(figure.mean_square[i]));
    }
  }
  return table;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

}  // namespace
}  // namespace switched

Result<Fit> learn_switched(std::span<const Recording> recordings, const SwitchedRecipe& recipe,
                           const Progress& progress) {
  if (recipe.modes == 0) return Error{"0 modes were requested, expected 1 to 64"};
  const ChannelChoice channels{recipe.inputs, recipe.outputs};
  const auto sources = arx::sources_of(recordings, channels);
  if (!sources) return sources.error();
  const auto orders = arx::orders_of(recipe.na, recipe.nb, recipe.nk, recipe.coupling, channels);
  if (!orders) return orders.error();
  const auto fitted = fit_switched(recordings, channels, switched::options_of(recipe, *orders), progress);
  if (!fitted) return fitted.error();
  Fit fit{arx::plain_model(recipe.name, channels, *sources), {}};
  fit.model.dynamics = fitted->model;
  fit.model.training = switched::training_of(*fitted, recipe, std::move(fit.model.training));
  switched::add_fit(*fitted, fit.model, fit.report);
  arx::add(fit.report.sections.back(), "seed", static_cast<std::int64_t>(recipe.seed));
  return fit;
}

Result<Report> validate_switched(const Model& model, const Recording& recording, const ValidationOptions& options,
                                 const Progress& progress) {
  const auto& dynamics = std::get<SwitchedArxModel>(model.dynamics);
  const ChannelChoice channels = arx::channels_of(model);
  if (options.steps.empty()) return Error{"no number of steps was requested"};
  if (auto ok = arx::check_progress(progress, "predicting", 0); !ok) return ok.error();
  const auto figures = switched_figures(dynamics, recording, channels, options.steps);
  if (!figures) return figures.error();
  if (auto ok = arx::check_progress(progress, "judging modes", 0.5); !ok) return ok.error();
  const auto likelihood = row_log_likelihoods(dynamics, {&recording, 1}, channels);
  if (!likelihood) return likelihood.error();
  const auto sequence = mode_sequence(dynamics, recording, channels);
  if (!sequence) return sequence.error();
  std::vector<std::size_t> acted(dynamics.modes.size(), 0);
  for (int mode : *sequence) {
    if (mode >= 0) ++acted[static_cast<std::size_t>(mode)];
  }
  Report report;
  ReportSection& section = report.add("Prediction and free simulation");
  for (const PredictionFigures& figure : *figures) {
    arx::add(section, "J." + arx::steps_id(figure.steps), switched::mean_of(figure.j));
  }
  arx::add(section, "rows", figures->front().rows, "rows judged");
  arx::add(section, "mode_rows", ReportList(acted.begin(), acted.end()), "rows in which each mode acts");
  arx::add(section, "log_likelihood", switched::mean_of(*likelihood), "log-likelihood", "nats a row");
  section.tables.push_back(switched::channel_table(*figures, channels));
  return report;
}

}  // namespace wisp
