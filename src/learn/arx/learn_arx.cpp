#include "learn/arx/learn_arx.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "learn/choose/focus.hpp"
#include "learn/choose/order_search.hpp"
#include "learn/judge/arx_verdict.hpp"
#include "learn/judge/held_out.hpp"
#include "learn/judge/judged_fit.hpp"
#include "learn/judge/residual_tests.hpp"
#include "learn/report/fit_report.hpp"
#include "learn/report/report_values.hpp"
#include "record/number_text.hpp"
#include "wisp/learn/prepare.hpp"

namespace wisp {
namespace arx {
namespace {

std::vector<Note> notes_of(const ArxRecipe& recipe, const ArxFit& fit) {
  const OrderMatrix& na = fit.model.orders.na;
  const bool apart = coupled_outputs(na).size() == static_cast<std::size_t>(na.rows());
  std::vector<Note> notes =
      order_notes(fit.model.orders, apart && na.rows() > 1 ? Coupling::kDiagonal : recipe.coupling);
  const auto& levels = fit.model.constant;  // focus_fit() and fit_integrators() may set kEstimate for other offsets
  const bool level = std::any_of(levels.begin(), levels.end(), [](double one) { return one != 0; });
  notes.push_back({"offset", std::string(word_of(level ? ArxOffset::kEstimate : recipe.offset))});
  if (recipe.kernel == ArxKernel::kTc) notes.push_back({"kernel", "tc"});
  if (fit.summary.stable.changed) notes.push_back({"radius", number_text(recipe.radius, 6)});
  return notes;
}

Result<ArxOrders> searched(std::span<const Recording> recordings, const ArxRecipe& recipe,
                           const ChannelChoice& channels, const Progress& progress, Report& report) {
  const ArxSearch& asked = *recipe.search;
  const SearchOptions options{.na = asked.na,
                              .nb = asked.nb,
                              .nk = asked.nk,
                              .coupling = recipe.coupling,
                              .by = asked.by,
                              .steps = asked.steps,
                              .offset = recipe.offset};
  std::vector<Recording> validation = asked.validation;
  if (validation.size() > 1 && recipe.offset == ArxOffset::kMean) {
    if (const auto found = gather_signals(validation, channels, recipe.offset); !found) return found.error();
    validation = about_own_levels(validation, channels);
  }
  const auto search = search_orders(recordings, validation, channels, options, progress);
  if (!search) return search.error();
  add_search(*search, channels.outputs, asked.by, report);
  return search->candidates[search->best].orders;
}

Result<ArxOrders> with_delays(std::span<const Recording> recordings, const ArxRecipe& recipe,
                              const ChannelChoice& channels, const Progress& progress, Report& report) {
  if (auto ok = check_progress(progress, "finding delays", 0); !ok) return ok.error();
  const int* lags = std::get_if<int>(&recipe.nb);
  const auto delays = estimate_delays(
      recordings, channels, {.most = recipe.max_delay, .nb = lags && *lags == 1 ? 1 : 2, .offset = recipe.offset});
  if (!delays) return delays.error();
  auto orders = orders_of(recipe.na, recipe.nb, delays->nk, recipe.coupling, channels);
  if (!orders) return orders.error();
  ReportSection& section = report.add("Delays");
  for (int i = 0; i < orders->outputs(); ++i) {
    for (int k = 0; k < orders->inputs(); ++k) {
      add(section, "", orders->nk(i, k), channels.inputs[k] + " to " + channels.outputs[i], "samples",
          delays->supported(i, k) == 0 ? "none is supported: 1 is taken" : "");
    }
  }
  add(section, "delays.most", delays->most, "longest that was tried", "samples");
  return orders;
}

Result<ArxOrders> chosen_orders(std::span<const Recording> recordings, const ArxRecipe& recipe,
                                const ChannelChoice& channels, const Progress& progress, Report& report) {
  if (recipe.search) return searched(recordings, recipe, channels, progress, report);
  if (!recipe.nk) return with_delays(recordings, recipe, channels, progress, report);
  return orders_of(recipe.na, recipe.nb, *recipe.nk, recipe.coupling, channels);
}

// Recordings prepared for learning. With offset kMean, several recordings are all shifted to their common means.
struct Prepared {
  std::vector<Recording> moved{};
  std::span<const Recording> seen;
  std::vector<Recording> judged{};  // all rows, or the central part of very long recordings
  ArxOptions options{};
  Sources sources{};
};

Result<Prepared> prepare(std::span<const Recording> recordings, const ArxRecipe& recipe, const ChannelChoice& channels,
                         const Progress& progress, Report& chosen) {
  auto sources = sources_of(recordings, channels);
  if (!sources) return sources.error();
  Prepared out{.seen = recordings, .sources = std::move(*sources)};
  out.sources.own_levels = recordings.size() > 1 && recipe.offset == ArxOffset::kMean;
  if (out.sources.own_levels) out.seen = out.moved = about_own_levels(recordings, channels);
  out.judged = middles_of(out.seen, kJudgedRows);
  const auto orders = chosen_orders(out.seen, recipe, channels, progress, chosen);
  if (!orders) return orders.error();
  out.options = fit_options(recipe, *orders);
  return out;
}

// Fits by least squares or with the requested kernel. Outputs that integrate get poles fixed next to 1.
Result<ArxFit> first_fit(Prepared& prepared, const ChannelChoice& channels, Report& chosen) {
  ArxOptions& options = prepared.options;
  auto plain = fit_arx(prepared.seen, channels, options);
  if (!plain || options.offset == ArxOffset::kNone || !options.stabilise) return plain;
  const std::vector<int> integrators = find_integrators(prepared.seen, channels, options, *plain);
  if (integrators.empty()) return plain;
  ReportSection& section = chosen.add("Integrators");
  for (std::size_t i = 0; i < integrators.size(); ++i) {
    add(section, element("integrators", i, "poles"), integrators[i],
        integrators[i] > 0 ? channels.outputs[i] + " integrates, poles at 1" : "");
  }
  return fit_integrators(prepared.seen, channels, integrators, options);
}

// Sets the summary's verdict from held-out rows, residual tests and remarks on the recordings.
void judge_fit(const Prepared& prepared, const ChannelChoice& channels, const ArxOptions& options,
               const ResidualTests* tests, ArxSummary& summary) {
  VerdictEvidence evidence{channels, options.orders, persistence_errors(prepared.judged, channels), tests};
  evidence.held_out = held_out_fits(prepared.judged, channels, options);
  evidence.integrators = options.integrators;
  const auto nb = options.orders.nb.values(), nk = options.orders.nk.values();
  int lags = 0;  // distance between the smallest and the largest lag of all inputs
  for (std::size_t p = 0; p < nk.size(); ++p)
    lags = std::max(lags, nk[p] + nb[p] - 1 - *std::min_element(nk.begin(), nk.end()));
  evidence.redundant = redundant_channels(prepared.seen, channels.inputs, lags);
  evidence.doubts = [&] {
    std::vector<Remark> doubts = feedback_of(prepared.seen, channels.inputs, channels.outputs);
    if (auto chance = coincidence(prepared.seen, channels, options.orders)) doubts.push_back(std::move(*chance));
    return doubts;
  };
  evidence.remarks = [&] { return remarks_on(prepared.seen, channels.inputs, channels.outputs); };
  judge_use(evidence, summary);
}

Result<Fit> learn_prepared(std::span<const Recording> recordings, ArxRecipe recipe, const Progress& progress) {
  const Preparation preparation = std::exchange(recipe.preparation, {});
  auto ready = prepare_all(recordings, preparation);
  if (!ready) return ready.error();
  if (recipe.search) {
    auto validation = prepare_all(recipe.search->validation, preparation);
    if (!validation) return validation.error();
    recipe.search->validation = std::move(*validation);
  }
  auto fit = learn_arx(*ready, recipe, progress);
  if (!fit) return fit;
  fit->model.training.preparation = preparation;
  add(fit->report.add("Preparation"), "preparation", text_of(preparation), "recordings prepared by", "",
      "those that the model is judged on later are prepared alike");
  return fit;
}

}  // namespace

Result<void> check_progress(const Progress& progress, std::string_view stage, double share) {
  if (go_on(progress, stage, share)) return {};
  return Error{std::string(kStopped)};
}

ArxOptions fit_options(const ArxRecipe& recipe, const ArxOrders& orders) {
  return {.orders = orders,
          .offset = recipe.offset,
          .kernel = recipe.kernel,
          .stabilise = !recipe.keep_unstable,
          .stability_margin = 1 - recipe.radius,
          .covariance = recipe.responses};  // needed by the confidence bands
}

Fit finish(const ArxFit& fit, const ArxRecipe& recipe, const ChannelChoice& channels, const Sources& sources) {
  Fit out{plain_model(recipe.name, channels, sources), {}};
  Model& model = out.model;
  model.dynamics = fit.model;
  model.training.own_levels = sources.own_levels;
  model.training.recipe = notes_of(recipe, fit);
  // In some units the FPE is beyond all numbers.
  if (std::isfinite(fit.summary.fpe)) model.training.figures = {{"fpe", fit.summary.fpe}};
  model.training.figures.push_back({"samples_used", static_cast<double>(fit.summary.rows)});
  model.training.usable = fit.summary.usable;
  add_fit(fit, model, out.report);
  if (recipe.responses) add_responses({fit.model, channels, sources.rate_hz, fit.covariance}, true, out.report);
  return out;
}

}  // namespace arx

Result<Fit> learn_arx(std::span<const Recording> recordings, const ArxRecipe& recipe, const Progress& progress) {
  if (auto ok = check_fields(recipe); !ok) return ok.error();
  if (recipe.kernel != ArxKernel::kNone && recipe.focus != ArxFocus::kPrediction) {
    return Error{"a kernel chooses the coefficients itself: it needs the focus prediction"};
  }
  if (recipe.preparation != Preparation{}) return arx::learn_prepared(recordings, recipe, progress);
  const ChannelChoice channels{recipe.inputs, recipe.outputs};
  Report chosen;
  auto prepared = arx::prepare(recordings, recipe, channels, progress, chosen);
  if (!prepared) return prepared.error();
  if (auto ok = arx::check_progress(progress, "fitting", 0); !ok) return ok.error();
  auto plain = arx::first_fit(*prepared, channels, chosen);
  if (!plain) return plain.error();
  const ArxModel squares = plain->model;
  auto focused = arx::focus_fit(prepared->seen, channels, prepared->options, std::move(*plain), recipe.focus, progress);
  if (!focused) return focused.error();
  if (auto ok = arx::check_progress(progress, "testing residuals", 0); !ok) return ok.error();
  const ResidualTestOptions testing{.lags = kReportedLags, .learned_from_it = true};
  const auto first = test_residuals(squares, prepared->judged, channels, testing);
  const auto tests =
      focused->outcome.changed ? test_residuals(focused->fit.model, prepared->judged, channels, testing) : first;
  arx::judge_fit(*prepared, channels, focused->options, first ? &*first : nullptr, focused->fit.summary);
  Fit fit = arx::finish(focused->fit, recipe, channels, prepared->sources);
  if (recipe.focus != ArxFocus::kPrediction) {
    fit.report.sections.push_back(arx::focus_section(focused->outcome, channels.outputs));
  }
  fit.report.append(std::move(chosen));
  if (tests) arx::add_tests(*tests, channels, fit.report);  // no tests: the recordings are too short
  return fit;
}

}  // namespace wisp
