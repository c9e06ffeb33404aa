#include "learn/arx/learn_arx.hpp"

#include <algorithm>
#include <cmath>

#include "learn/arx/arx_curves.hpp"
#include "learn/arx/judge/arx_verdict.hpp"
#include "learn/arx/judge/residual_tests.hpp"
#include "learn/arx/report/fit_report.hpp"
#include "learn/arx/report/report_values.hpp"
#include "learn/arx/report/response_report.hpp"
#include "learn/arx/search/order_search.hpp"
#include "learn/choose/focus.hpp"
#include "record/number_text.hpp"

namespace wisp {
namespace arx {
namespace {

std::string word_of(ArxOffset offset) {
  if (offset == ArxOffset::kNone) return "none";
  return offset == ArxOffset::kEstimate ? "estimate" : "mean";
}

std::vector<Note> notes_of(const ArxRecipe& recipe, const ArxFit& fit, const Sources& sources) {
  const OrderMatrix& na = fit.model.orders.na;
  const bool apart = arx::coupled_outputs(na).size() == static_cast<std::size_t>(na.rows());
  std::vector<Note> notes =
      order_notes(fit.model.orders, apart && na.rows() > 1 ? Coupling::kDiagonal : recipe.coupling);
  const auto& levels = fit.model.constant;  // the focus may have estimated them
  const bool level = std::any_of(levels.begin(), levels.end(), [](double one) { return one != 0; });
  notes.push_back({"offset", word_of(level ? ArxOffset::kEstimate : recipe.offset)});
  if (recipe.ridge > 0) notes.push_back({"ridge", number_text(recipe.ridge, 6)});
  if (recipe.kernel == ArxKernel::kTc) notes.push_back({"kernel", "tc"});
  const std::size_t knots = sources.curves.empty() ? 0 : sources.curves.front().at.size();
  notes.push_back({"input-curve", std::to_string(knots)});
  if (fit.summary.stable.changed) notes.push_back({"radius", number_text(recipe.radius, 6)});
  return notes;
}

// Orders, and the first row that is predicted where it is not the orders' own.
struct ChosenOrders {
  ArxOrders orders;
  std::optional<int> first_sample{};
};

Result<ChosenOrders> searched(std::span<const Recording> recordings, const ArxRecipe& recipe,
                              const ChannelChoice& channels, const Progress& progress, Report& report) {
  const ArxSearch& asked = *recipe.search;
  const SearchOptions options{.na = asked.na,
                              .nb = asked.nb,
                              .nk = asked.nk,
                              .coupling = recipe.coupling,
                              .candidates = {},
                              .by = asked.by,
                              .steps = asked.steps,
                              .common_start = asked.common_start,
                              .offset = recipe.offset};
  const auto search = search_orders(recordings, asked.validation, channels, options, progress);
  if (!search) return search.error();
  add_search(*search, channels.outputs, asked.by, report);
  ChosenOrders chosen{asked.per_output ? search->row_orders : search->candidates[search->best].orders};
  if (!asked.common_start) return chosen;
  int latest = 0;
  for (const OrderCandidate& one : search->candidates) latest = std::max(latest, one.orders.history());
  chosen.first_sample = latest;
  return chosen;
}

Result<ChosenOrders> with_delays(std::span<const Recording> recordings, const ArxRecipe& recipe,
                                 const ChannelChoice& channels, const Progress& progress, Report& report) {
  if (auto ok = check_progress(progress, "finding delays", 0); !ok) return ok.error();
  const auto delays = estimate_delays(recordings, channels, {.offset = recipe.offset});
  if (!delays) return delays.error();
  auto orders = orders_of(recipe.na, recipe.nb, *delays, recipe.coupling, channels);
  if (!orders) return orders.error();
  ReportSection& section = report.add("Delays");
  for (int i = 0; i < orders->outputs(); ++i) {
    for (int k = 0; k < orders->inputs(); ++k) {
      add(section, "", orders->nk(i, k), channels.inputs[k] + " to " + channels.outputs[i], "samples");
    }
  }
  return ChosenOrders{std::move(*orders)};
}

Result<ChosenOrders> chosen_orders(std::span<const Recording> recordings, const ArxRecipe& recipe,
                                   const ChannelChoice& channels, const Progress& progress, Report& report) {
  if (recipe.search) return searched(recordings, recipe, channels, progress, report);
  if (!recipe.nk) return with_delays(recordings, recipe, channels, progress, report);
  auto orders = orders_of(recipe.na, recipe.nb, *recipe.nk, recipe.coupling, channels);
  if (!orders) return orders.error();
  return ChosenOrders{std::move(*orders)};
}

Result<void> check_recipe(const ArxRecipe& recipe) {
  if (!(recipe.radius > 0 && recipe.radius < 1)) {
    return Error{"the radius is " + number_text(recipe.radius) + ", expected a number between 0 and 1"};
  }
  if (recipe.kernel != ArxKernel::kNone && recipe.focus != ArxFocus::kPrediction) {
    return Error{"a kernel chooses the coefficients itself: it needs the focus prediction"};
  }
  if (recipe.curve_knots != 0 && recipe.offset == ArxOffset::kNone) {
    return Error{"curves on inputs need the offset mean or estimate: a curve has no level of its own"};
  }
  return {};
}

}  // namespace

Result<void> check_progress(const Progress& progress, std::string_view stage, double share) {
  if (go_on(progress, stage, share)) return {};
  return Error{std::string(kStopped)};
}

ArxOptions fit_options(const ArxRecipe& recipe, const ArxOrders& orders) {
  ArxOptions options;
  options.orders = orders;
  options.offset = recipe.offset;
  options.ridge = recipe.ridge;
  options.kernel = recipe.kernel;
  options.covariance = recipe.responses;  // for the bands
  options.stabilise = !recipe.keep_unstable;
  options.stability_margin = 1 - recipe.radius;
  return options;
}

Fit finish(const ArxFit& fit, const ArxRecipe& recipe, const ChannelChoice& channels, const Sources& sources) {
  Fit out{plain_model(recipe.name, channels, sources), {}};
  Model& model = out.model;
  model.dynamics = fit.model;
  model.training.recipe = notes_of(recipe, fit, sources);
  model.training.figures = {{"fpe", fit.summary.fpe}, {"samples_used", static_cast<double>(fit.summary.samples_used)}};
  model.training.usable = fit.summary.usable;
  add_fit(fit, model, out.report);
  if (recipe.responses) add_responses({fit.model, channels, sources.rate_hz, fit.covariance}, true, out.report);
  return out;
}

}  // namespace arx

Result<Fit> learn_arx(std::span<const Recording> recordings, const ArxRecipe& recipe, const Progress& progress) {
  if (auto ok = arx::check_recipe(recipe); !ok) return ok.error();
  const ChannelChoice channels{recipe.inputs, recipe.outputs};
  auto sources = arx::sources_of(recordings, channels);
  if (!sources) return sources.error();
  Report chosen;
  const auto orders = arx::chosen_orders(recordings, recipe, channels, progress, chosen);
  if (!orders) return orders.error();
  auto curves = arx::learn_curves(recordings, channels, orders->orders, recipe.curve_knots, progress, chosen);
  if (!curves) return curves.error();
  sources->curves = std::move(*curves);
  std::vector<Recording> bent;
  if (!sources->curves.empty()) bent = arx::with_curves(recordings, channels.inputs, sources->curves);
  const std::span<const Recording> seen = bent.empty() ? recordings : bent;
  if (auto ok = arx::check_progress(progress, "fitting", 0); !ok) return ok.error();
  ArxOptions options = arx::fit_options(recipe, orders->orders);
  options.first_sample = orders->first_sample;
  auto plain = fit_arx(seen, channels, options);
  if (!plain) return plain.error();
  const ArxModel squares = plain->model;
  auto focused = arx::focus_fit(seen, channels, options, std::move(*plain), recipe.focus, progress);
  if (!focused) return focused.error();
  if (auto ok = arx::check_progress(progress, "testing residuals", 0); !ok) return ok.error();
  const ResidualTestOptions testing{.lags = kReportedLags, .learned_from_it = true};
  const auto first = test_residuals(squares, seen, channels, testing);
  const auto tests = focused->outcome.changed ? test_residuals(focused->fit.model, seen, channels, testing) : first;
  arx::judge_use(
      {channels, focused->fit.model.orders, arx::persistence_errors(seen, channels), first ? &*first : nullptr},
      focused->fit.summary);
  Fit fit = arx::finish(focused->fit, recipe, channels, *sources);
  if (recipe.focus != ArxFocus::kPrediction) {
    fit.report.sections.push_back(arx::focus_section(focused->outcome, channels.outputs));
  }
  fit.report.append(std::move(chosen));
  if (tests) arx::add_tests(*tests, channels, fit.report);  // too short: nothing can be said
  return fit;
}

}  // namespace wisp
