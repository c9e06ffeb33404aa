#include "learn/arx/simulation/focus.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "learn/arx/fit/given_rows.hpp"
#include "learn/arx/rows/arx_rows.hpp"
#include "learn/arx/simulation/subspace.hpp"
#include "learn/arx/simulation/ways.hpp"

namespace wisp::arx {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr const char* kRankless = "the data cannot tell all coefficients";

std::vector<Block> blocks_of(const ArxOrders& orders, bool keep_orders) {
  std::vector<Block> blocks;
  for (std::vector<int>& outputs : coupled_outputs(orders.na)) {
    Block& block = blocks.emplace_back(Block{{outputs}});
    for (int output : outputs) {
      if (outputs.size() > 1 && !keep_orders) block.apart.push_back({{output}, true});
    }
  }
  return blocks;
}

// Adds what a fold says of every way to go.
void judge_unit(const Subject& subject, const LearnedRows& learned, const Signals& held_out, Unit& unit) {
  const SimulationBlock unseen(held_out, learned.given.model_of(unit).orders, unit.outputs, subject.constant(),
                               subject.judged_from());
  if (unseen.runs().empty() || !(unseen.weight().array() > 0).all()) return;
  std::vector<Way> ways = ways_of(subject, learned, unit);
  if (unit.candidates.empty()) {
    for (const Way& way : ways) unit.candidates.push_back(way.candidate);
    unit.squares.resize(Index(ways.size()), 0);
    unit.estimated.resize(Index(ways.size()), 0);
    unit.by_output = MatrixXd::Zero(Index(ways.size()), Index(unit.outputs.size()));
  }
  if (unit.candidates.size() != ways.size()) return;
  const Index before = unit.squares.cols();
  unit.squares.conservativeResize(Eigen::NoChange, before + kParts);
  unit.estimated.conservativeResize(Eigen::NoChange, before + kParts);
  for (std::size_t w = 0; w < ways.size(); ++w) {
    const HeldOutErrors errors = errors_of(subject, held_out, unit, ways[w], unseen);
    unit.squares.row(Index(w)).tail(kParts) = (errors.estimated + errors.measured).transpose();
    unit.estimated.row(Index(w)).tail(kParts) = errors.estimated.transpose();
    unit.by_output.row(Index(w)) += errors.by_output.transpose();
    unit.candidates[w].estimated_error += errors.estimated.mean();
    unit.candidates[w].measured_error += errors.measured.mean();
    if (w == 0) unit.sizes.push_back(errors.size);
  }
}

Result<void> judge_folds(const Subject& subject, std::vector<Block>& blocks) {
  const bool several = std::any_of(blocks.begin(), blocks.end(), [](const Block& one) { return !one.apart.empty(); });
  for (const Fold& fold : folds_of(subject.some_rows())) {
    const auto learned = learn_rows(subject, fold.learned, several);
    auto held_out = find_signals(fold.held_out, subject.channels);
    if (!learned || !held_out) continue;  // too few rows to hold some out
    if (subject.refines && !learned->given.coupled.summary.rank_problems.empty()) continue;  // an input at rest, say
    held_out->offset = learned->given.signals.offset;
    held_out->scale = learned->given.signals.scale;
    for (Block& block : blocks) {
      judge_unit(subject, *learned, *held_out, block.together);
      for (Unit& unit : block.apart) judge_unit(subject, *learned, *held_out, unit);
      if (!go_on(subject.progress, "refining", -1)) return Error{std::string(kStopped)};
    }
  }
  return {};
}

std::vector<FocusChoice> choices_of(std::vector<Block>& blocks) {
  std::vector<FocusChoice> choices;
  for (Block& block : blocks) {
    for (const Unit* unit : block.chosen()) {
      FocusChoice& choice = choices.emplace_back(FocusChoice{unit->outputs, unit->picked, unit->candidates});
      const double size = std::accumulate(unit->sizes.begin(), unit->sizes.end(), 0.0);
      for (FocusCandidate& one : choice.candidates) {
        one.estimated_error = std::sqrt(one.estimated_error / size);
        one.measured_error = std::sqrt(one.measured_error / size);
      }
    }
  }
  return choices;
}

// Why nothing can be refined, or nothing.
std::string obstacle(const Subject& subject, ArxFocus focus) {
  const auto& nb = subject.options.orders.nb.values();
  const auto& na = subject.options.orders.na.values();
  const auto positive = [](int order) { return order > 0; };
  if (focus == ArxFocus::kPrediction) return "one step ahead, as requested";
  if (std::none_of(nb.begin(), nb.end(), positive)) return "no input drives a free simulation";
  if (std::none_of(na.begin(), na.end(), positive)) return "without feedback a prediction is a simulation";
  if (!subject.refines && !subject.subspace) return kRankless;
  if (!subject.options.stabilise) return "an unstable estimate was to be kept";
  return "";
}

// The orders of what was chosen.
ArxOrders chosen_orders(const Subject& subject, std::vector<Block>& blocks) {
  ArxOrders orders = subject.options.orders;
  for (Block& block : blocks) {
    if (block.decoupled) orders = decoupled_orders(std::move(orders), block.together.outputs);
  }
  const ArxOrders given = orders;
  for (Block& block : blocks) {
    for (const Unit* unit : block.chosen()) {
      const ArxOrders many = kernel_orders(given, unit->kernel_lags());
      for (int output : unit->outputs) {
        if (unit->kernel_lags() == 0) continue;
        for (int j = 0; j < orders.outputs(); ++j) orders.na(output, j) = many.na(output, j);
        for (int k = 0; k < orders.inputs(); ++k) {
          orders.nb(output, k) = many.nb(output, k);
          orders.nk(output, k) = many.nk(output, k);
        }
      }
      if (unit->states() == 0) continue;
      const int lags = arx_lags(unit->states(), static_cast<int>(unit->outputs.size()));
      orders = state_space_orders(std::move(orders), unit->outputs, lags);
    }
  }
  return orders;
}

// The rows of one unit from a subspace estimate. Returns whether there is one.
bool give_state_space(const Subject& subject, const Learned& learned, const Unit& unit, std::vector<GivenRow>& rows) {
  const bool constant = subject.options.offset == ArxOffset::kEstimate;
  const auto model = Subspace(learned.signals, unit.outputs, constant).model(unit.states(), subject.largest_pole());
  if (!model) return false;
  const Index outputs = model->outputs(), inputs = model->inputs();
  const int lags = arx_lags(unit.states(), model->outputs());
  const ArxForm form = arx_form(*model, lags);
  const double shared = model->states() * static_cast<double>(outputs + inputs) / static_cast<double>(outputs);
  for (Index o = 0; o < outputs; ++o) {
    GivenRow& row = rows[std::size_t(unit.outputs[std::size_t(o)])];
    row.theta << form.feedback.row(o).reshaped(outputs, lags).transpose().reshaped(),
        form.drive.row(o).reshaped(inputs, lags + 1).transpose().reshaped(),
        form.constant.row(o).head(subject.constant() ? 1 : 0);
    row.effective = shared + static_cast<double>(inputs) + (constant ? 1 : 0);
  }
  return true;
}

// The rows of one unit, refined on all rows as far as was chosen.
void give_refined(const Subject& subject, const LearnedRows& learned, const Unit& unit, std::vector<GivenRow>& rows) {
  const RefinedRows best = refined_rows(subject, learned, unit);
  Index at = 0;
  for (int output : unit.outputs) {
    GivenRow& row = rows[std::size_t(output)];
    const Index size = row.theta.size();
    row.theta = best.theta.segment(at, size);
    if (best.covariance.size() > 0) row.covariance = best.covariance.block(at, at, size, size);
    at += size;
  }
}

// The rows of one unit as chosen, learned from all rows. Returns whether they are other than least squares'.
bool give_chosen(const Subject& subject, const LearnedRows& learned, const Unit& unit, std::vector<GivenRow>& rows,
                 ArxFit& plain) {
  if (unit.states() > 0) return give_state_space(subject, learned.given, unit, rows);
  if (unit.refined()) give_refined(subject, learned, unit, rows);
  if (unit.kernel_lags() == 0) return unit.refined();
  const auto tried = std::find(subject.kernel_lags.begin(), subject.kernel_lags.end(), unit.kernel_lags());
  const auto place = std::size_t(tried - subject.kernel_lags.begin());
  const ArxModel& kernel = learned.given.kernels_of(unit)[place]->model;
  for (int output : unit.outputs) {
    rows[std::size_t(output)] = row_of_model(kernel, output, learned.given.signals, subject.level());
    plain.model.std_error[std::size_t(output)] = kernel.std_error[std::size_t(output)];
  }
  return true;
}

Result<ArxFit> refit(const Subject& subject, std::vector<Block>& blocks, ArxFit plain) {
  ArxOptions options = subject.options;
  options.orders = chosen_orders(subject, blocks);
  options.first_sample = std::max(subject.first_sample(), options.orders.history());
  const bool decoupled = std::any_of(blocks.begin(), blocks.end(), [](const Block& one) { return one.decoupled; });
  auto learned = learn_rows(subject, subject.recordings, decoupled);
  if (!learned) return learned.error();
  if (!(options.orders == subject.options.orders)) {
    auto again = fit_arx(subject.recordings, subject.channels, options);
    if (!again) return again.error();
    plain = std::move(*again);
  }
  std::vector<GivenRow> rows;
  rows.reserve(static_cast<std::size_t>(plain.model.orders.outputs()));
  for (int i = 0; i < plain.model.orders.outputs(); ++i) {
    rows.push_back(row_of_model(plain.model, i, learned->given.signals, subject.level()));
  }
  bool all = true;
  for (Block& block : blocks) {
    for (const Unit* unit : block.chosen()) {
      all &= give_chosen(subject, *learned, *unit, rows, plain);
      if (!go_on(subject.progress, "refining", -1)) return Error{std::string(kStopped)};
    }
  }
  options.offset = subject.level();
  auto fit = fit_with_rows(subject.recordings, subject.channels, options, rows, plain);
  if (!fit || all || !plain.summary.stable.changed) return fit;
  const double radius = fit->summary.stable.radius;
  fit->summary.stable = plain.summary.stable;
  fit->summary.stable.radius = radius;
  return fit;
}

// Many lags are tried where the coefficients are nobody else's and every stretch is long beside them.
bool many_lags_are_tried(std::span<const Recording> recordings, const ArxOptions& options, const FocusOptions& asked,
                         int lags) {
  if (asked.focus != ArxFocus::kAuto || asked.keep_orders || options.ridge > 0) return false;
  return std::all_of(recordings.begin(), recordings.end(), [&](const Recording& one) {
    return one.rows() >= std::size_t(10 * lags) * std::max<std::size_t>(1, episodes(one).size());
  });
}

// Few enough coefficients for the time that a kernel takes, which is of their cubes.
bool kernel_has_time(const Subject& subject, int lags) {
  constexpr double kMaxWork = 2e7;
  if (subject.many_rows() && lags > kKernelLags[0]) return false;
  const ArxOrders orders = kernel_orders(subject.options.orders, lags);
  double work = 0;
  for (int i = 0; i < orders.outputs(); ++i) work += std::pow(orders.row_size(i), 3);
  return work <= kMaxWork;
}

}  // namespace

Result<FocusedFit> focus_fit(std::span<const Recording> recordings, const ChannelChoice& channels,
                             const ArxOptions& options, ArxFit plain, const FocusOptions& asked,
                             const Progress& progress) {
  const bool refines = plain.summary.rank_problems.empty();
  const bool states = many_lags_are_tried(recordings, options, asked, kKernelLags[0]);
  Subject subject{recordings, channels, options, progress, {}, states, refines};
  for (int lags : kKernelLags) {
    const bool tried = refines && many_lags_are_tried(recordings, options, asked, lags);
    if (tried && kernel_has_time(subject, lags)) subject.kernel_lags.push_back(lags);
  }
  subject.at_zero = options.offset == ArxOffset::kMean && !asked.keep_orders && lie_off_zero(recordings, channels);
  FocusedFit out{std::move(plain), {.reason = obstacle(subject, asked.focus)}};
  FocusOutcome& outcome = out.outcome;
  if (!outcome.reason.empty()) return out;
  std::vector<Block> blocks = blocks_of(options.orders, asked.keep_orders);
  if (auto ok = judge_folds(subject, blocks); !ok) return ok.error();
  bool judged = false, changed = false;
  for (Block& block : blocks) {
    block.pick(asked.focus == ArxFocus::kSimulation);
    changed |= block.decoupled;
    for (const Unit* unit : block.chosen()) {
      judged |= !unit->candidates.empty();
      changed |= unit->picked > 0;
    }
  }
  outcome.choices = choices_of(blocks);
  outcome.reason = !judged                                ? "too few rows to hold some out"
                   : asked.focus == ArxFocus::kSimulation ? "free simulation, as requested"
                   : changed  ? "held-out free runs are surely better than with least squares"
                   : !refines ? kRankless
                              : "held-out free runs are no better than with least squares";
  if (!changed) return out;
  auto fit = refit(subject, blocks, std::move(out.fit));
  if (!fit) return fit.error();
  out.fit = std::move(*fit);
  outcome.refined = true;
  return out;
}

}  // namespace wisp::arx
