#include "learn/arx/simulation/focus.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "learn/arx/fit/given_rows.hpp"
#include "learn/arx/rows/arx_rows.hpp"
#include "learn/arx/simulation/held_out.hpp"
#include "learn/arx/simulation/refine.hpp"
#include "record/number_text.hpp"

namespace wisp::arx {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kManyRows = 8192;         // more hardly tell more of which way is best:
constexpr std::size_t kRowsOfMany = 4096;       // of them so many decide
constexpr std::size_t kMaxTerms = 120;          // coefficients that are refined together
constexpr std::size_t kMaxTriedTerms = 24;      // of which every way is tried
constexpr double kFewWeights[] = {10, 1, 0.1};  // tried for more
constexpr int kFewSteps = 15;
constexpr double kFewTolerance = 1e-3;
constexpr double kAsGood = 1.05;  // a root mean square within this factor of the least is as good
constexpr double kSure = 1;       // standard errors by which parts must be better than least squares'
constexpr int kMaxBatches = 64;
constexpr std::size_t kMinBatchRows = 10;
constexpr int kMaxPolishing = 2;  // steps over all rows, from what some of them say

// What is asked for.
struct Subject {
  std::span<const Recording> recordings;
  const ChannelChoice& channels;
  const ArxOptions& options;
  const Progress& progress;

  bool many_rows() const {
    std::size_t rows = 0;
    for (const Recording& one : recordings) rows += one.rows();
    return rows > kManyRows;
  }
  std::vector<Recording> some_rows() const { return middles_of(recordings, many_rows() ? kRowsOfMany : kManyRows); }
  int first_sample() const { return options.first_sample.value_or(options.orders.history()); }
};

// One set of outputs that is simulated together, and how the ways to go did on held-out rows.
struct Unit {
  std::vector<int> outputs;
  bool decoupled = false;  // taken out of a block of several
  std::vector<FocusCandidate> candidates{};
  MatrixXd squares{};  // a row a candidate, a column a part of a fold: both kinds of starts together
  double size = 0;     // of the outputs themselves, summed over folds
  std::size_t picked = 0;

  double mean_square(std::size_t candidate) const { return squares.row(Index(candidate)).mean(); }
  bool refined() const { return candidates[picked].one_step_weight.has_value(); }
};

// Outputs that feed each other: together, and, where there are several, each on its own.
struct Block {
  Unit together;
  std::vector<Unit> apart{};
  bool decoupled = false;  // as chosen

  std::vector<Unit*> chosen() {
    std::vector<Unit*> units;
    if (!decoupled) return {&together};
    for (Unit& unit : apart) units.push_back(&unit);
    return units;
  }
};

// Least squares for some rows.
struct Learned {
  Signals signals;
  ArxFit coupled;
  std::optional<ArxFit> decoupled{};

  const ArxModel& model_of(const Unit& unit) const { return unit.decoupled ? decoupled->model : coupled.model; }
};

ArxOrders decoupled_orders(ArxOrders orders, const std::vector<int>& outputs) {
  for (int i : outputs) {
    for (int j : outputs) {
      if (i != j) orders.na(i, j) = 0;
    }
  }
  return orders;
}

std::vector<Block> blocks_of(const ArxOrders& orders) {
  std::vector<Block> blocks;
  for (std::vector<int>& outputs : coupled_outputs(orders.na)) {
    Block& block = blocks.emplace_back(Block{{outputs}});
    for (int output : outputs) {
      if (outputs.size() > 1) block.apart.push_back({{output}, true});
    }
  }
  return blocks;
}

Result<Learned> learn_rows(const Subject& subject, std::span<const Recording> recordings, bool with_decoupled) {
  auto signals = gather_signals(recordings, subject.channels, subject.options.offset);
  if (!signals) return signals.error();
  ArxOptions options = subject.options;
  options.judge_free_run = options.covariance = false;
  options.first_sample = subject.first_sample();
  auto coupled = fit_arx(recordings, subject.channels, options);
  if (!coupled) return coupled.error();
  Learned learned{std::move(*signals), std::move(*coupled)};
  if (!with_decoupled) return learned;
  std::vector<int> all(subject.channels.outputs.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  options.orders = decoupled_orders(options.orders, all);
  auto decoupled = fit_arx(recordings, subject.channels, options);
  if (!decoupled) return decoupled.error();
  learned.decoupled = std::move(*decoupled);
  return learned;
}

SimulationBlock simulation_of(const Subject& subject, const Signals& signals, const Learned& learned,
                              const Unit& unit) {
  return SimulationBlock(signals, learned.model_of(unit).orders, unit.outputs,
                         subject.options.offset == ArxOffset::kEstimate, subject.first_sample());
}

VectorXd least_squares(const Subject& subject, const Learned& learned, const Unit& unit) {
  std::vector<double> theta;
  for (int output : unit.outputs) {
    const GivenRow row = row_of_model(learned.model_of(unit), output, learned.signals, subject.options.offset);
    theta.insert(theta.end(), row.theta.begin(), row.theta.end());
  }
  return Eigen::Map<const VectorXd>(theta.data(), Index(theta.size()));
}

// How thoroughly a block is worked on.
bool is_expensive(const Subject& subject, const SimulationBlock& block) {
  return subject.many_rows() || block.terms().size() > kMaxTriedTerms;
}

std::span<const double> weights_for(const Subject& subject, const SimulationBlock& block) {
  if (!block.refinable() || block.terms().size() > kMaxTerms) return {};
  if (is_expensive(subject, block)) return kFewWeights;
  return kOneStepWeights;
}

std::vector<Refined> refine_unit(const Subject& subject, const Learned& learned, const Unit& unit,
                                 const SimulationBlock& block, std::span<const double> weights) {
  const VectorXd squares = least_squares(subject, learned, unit);
  const OneStepLoss loss = one_step_loss(learned.signals, block, learned.model_of(unit).orders, subject.options.offset,
                                         subject.first_sample());
  const bool few = is_expensive(subject, block);
  std::vector<VectorXd> starts;
  if (!few) starts = other_starts(block, squares);
  starts.insert(starts.begin(), squares);
  RefineOptions options;
  if (few) options.steps = kFewSteps, options.tolerance = kFewTolerance;
  options.go_on = [&] { return go_on(subject.progress, "refining", -1); };
  return refined_path(block, loss, starts, weights, options);
}

// Adds what a fold says of every way to go.
void judge_unit(const Subject& subject, const Learned& learned, const Signals& held_out, Unit& unit) {
  const SimulationBlock seen = simulation_of(subject, learned.signals, learned, unit);
  const SimulationBlock unseen = simulation_of(subject, held_out, learned, unit);
  if (unseen.runs().empty() || !(unseen.weight().array() > 0).all()) return;
  std::vector<VectorXd> ways{least_squares(subject, learned, unit)};
  const auto weights = weights_for(subject, seen);
  if (!weights.empty()) {
    for (Refined& one : refine_unit(subject, learned, unit, seen, weights)) {
      ways.push_back(std::move(one.simulation.theta));
    }
  }
  if (unit.candidates.empty()) {
    unit.candidates.push_back({.decoupled = unit.decoupled});
    for (double weight : weights) unit.candidates.push_back({weight, unit.decoupled});
    unit.squares.resize(Index(ways.size()), 0);
  }
  if (unit.candidates.size() != ways.size()) return;
  const Index before = unit.squares.cols();
  unit.squares.conservativeResize(Eigen::NoChange, before + kParts);
  for (std::size_t w = 0; w < ways.size(); ++w) {
    const HeldOutErrors errors = held_out_errors(unseen, ways[w]);
    unit.squares.row(Index(w)).tail(kParts) = (errors.estimated + errors.measured).transpose();
    unit.candidates[w].estimated_error += errors.estimated.mean();
    unit.candidates[w].measured_error += errors.measured.mean();
    if (w == 0) unit.size += errors.size;
  }
}

Result<void> judge_folds(const Subject& subject, std::vector<Block>& blocks) {
  const bool several = std::any_of(blocks.begin(), blocks.end(), [](const Block& one) { return !one.apart.empty(); });
  for (const Fold& fold : folds_of(subject.some_rows())) {
    const auto learned = learn_rows(subject, fold.learned, several);
    auto held_out = find_signals(fold.held_out, subject.channels);
    if (!learned || !held_out) continue;  // too few rows to hold some out
    held_out->offset = learned->signals.offset;
    held_out->scale = learned->signals.scale;
    for (Block& block : blocks) {
      judge_unit(subject, *learned, *held_out, block.together);
      for (Unit& unit : block.apart) judge_unit(subject, *learned, *held_out, unit);
      if (!go_on(subject.progress, "refining", -1)) return Error{std::string(kStopped)};
    }
  }
  return {};
}

// By how many standard errors the parts' logarithms are less with `one` than with `other`.
double sureness(const MatrixXd& squares, std::size_t one, const MatrixXd& others, std::size_t other) {
  const Eigen::ArrayXd gain = (others.row(Index(other)).array() + 1e-300).log().transpose() -
                              (squares.row(Index(one)).array() + 1e-300).log().transpose();
  const double mean = gain.mean(), n = static_cast<double>(gain.size());
  const double error = std::sqrt((gain - mean).square().sum() / (n * (n - 1)));
  return error > 0 ? mean / error : mean > 0 ? std::numeric_limits<double>::infinity() : 0;
}

// The best; where least squares would do, of all that are as good the one that is nearest to it.
void pick(Unit& unit, ArxFocus focus) {
  const std::size_t first = focus == ArxFocus::kSimulation && unit.candidates.size() > 1 ? 1 : 0;
  std::size_t best = first;
  for (std::size_t w = first; w < unit.candidates.size(); ++w) {
    if (unit.mean_square(w) < unit.mean_square(best)) best = w;
  }
  unit.picked = best;
  if (first == 1) return;
  unit.picked = 0;
  while (unit.mean_square(unit.picked) > kAsGood * kAsGood * unit.mean_square(best)) ++unit.picked;
  if (unit.picked > 0 && sureness(unit.squares, unit.picked, unit.squares, 0) < kSure) unit.picked = 0;
}

void pick(Block& block, ArxFocus focus) {
  if (!block.together.candidates.empty()) pick(block.together, focus);
  if (block.apart.empty()) return;
  MatrixXd apart;
  for (Unit& unit : block.apart) {
    if (unit.candidates.empty()) return;
    pick(unit, focus);
    const MatrixXd own = unit.squares.row(Index(unit.picked)) / static_cast<double>(block.apart.size());
    apart = apart.size() == 0 ? own : MatrixXd(apart + own);
  }
  if (block.together.candidates.empty() || apart.cols() != block.together.squares.cols()) return;
  block.decoupled = apart.mean() * kAsGood * kAsGood < block.together.mean_square(block.together.picked) &&
                    sureness(apart, 0, block.together.squares, 0) >= kSure;
}

MatrixXd covariance_of(const SimulationBlock& block, const OneStepLoss& loss, const Refined& at, std::size_t rows) {
  const auto batches = static_cast<int>(std::clamp<std::size_t>(rows / kMinBatchRows, 2, kMaxBatches));
  GaussNewton model = gauss_newton(block, at.simulation);
  MatrixXd gradients = batch_gradients(block, at.simulation, batches);
  if (at.one_step_weight > 0) {
    loss.add_to(at.simulation.theta, at.one_step_weight, model);
    gradients += loss.batch_gradients(at.simulation.theta, at.one_step_weight, batches);
  }
  gradients.colwise() -= gradients.rowwise().mean().eval();
  const MatrixXd scatter = gradients * gradients.transpose() * (batches / (batches - 1.0));
  const Eigen::LDLT<MatrixXd> solver(model.curvature);
  return solver.solve(solver.solve(scatter).transpose());
}

// The best for all rows: of many, from what is best for some of them.
Refined best_of(const Subject& subject, const Learned& learned, const Unit& unit, const SimulationBlock& block,
                const OneStepLoss& loss) {
  const double weight = *unit.candidates[unit.picked].one_step_weight;
  if (!subject.many_rows()) return refine_unit(subject, learned, unit, block, {&weight, 1}).front();
  const std::vector<Recording> some = subject.some_rows();
  Learned part{*find_signals(some, subject.channels), learned.coupled, learned.decoupled};
  part.signals.offset = learned.signals.offset;
  part.signals.scale = learned.signals.scale;
  const SimulationBlock few = simulation_of(subject, part.signals, part, unit);
  const Refined start = refine_unit(subject, part, unit, few, {&weight, 1}).front();
  return refine(block, loss, start.simulation.theta,
                {.one_step_weight = start.one_step_weight, .steps = kMaxPolishing, .tolerance = 1e-4, .go_on = [&] {
                   return go_on(subject.progress, "refining", -1);
                 }});
}

// The rows of one unit, refined on all rows as far as was chosen.
void give_refined(const Subject& subject, const Learned& learned, const Unit& unit, std::vector<GivenRow>& rows) {
  const SimulationBlock block = simulation_of(subject, learned.signals, learned, unit);
  const OneStepLoss loss = one_step_loss(learned.signals, block, learned.model_of(unit).orders, subject.options.offset,
                                         subject.first_sample());
  const Refined best = best_of(subject, learned, unit, block, loss);
  const MatrixXd covariance = covariance_of(block, loss, best, learned.coupled.summary.samples_used);
  Index at = 0;
  for (int output : unit.outputs) {
    const Index size = rows[std::size_t(output)].theta.size();
    rows[std::size_t(output)] = {best.simulation.theta.segment(at, size), covariance.block(at, at, size, size)};
    at += size;
  }
}

std::vector<FocusChoice> choices_of(std::vector<Block>& blocks) {
  std::vector<FocusChoice> choices;
  for (Block& block : blocks) {
    for (const Unit* unit : block.chosen()) {
      FocusChoice& choice = choices.emplace_back(FocusChoice{unit->outputs, unit->picked, unit->candidates});
      for (FocusCandidate& one : choice.candidates) {
        one.estimated_error = std::sqrt(one.estimated_error / unit->size);
        one.measured_error = std::sqrt(one.measured_error / unit->size);
      }
    }
  }
  return choices;
}

// Why nothing can be refined, or nothing.
std::string obstacle(const Subject& subject, const ArxFit& plain, ArxFocus focus) {
  const auto& nb = subject.options.orders.nb.values();
  const auto& na = subject.options.orders.na.values();
  const auto positive = [](int order) { return order > 0; };
  if (focus == ArxFocus::kPrediction) return "one step ahead, as asked for";
  if (std::none_of(nb.begin(), nb.end(), positive)) return "no input drives a free simulation";
  if (std::none_of(na.begin(), na.end(), positive)) return "without feedback a prediction is a simulation";
  if (!plain.summary.rank_problems.empty()) return "the data cannot tell all coefficients";
  if (!subject.options.stabilise) return "an unstable estimate was to be kept";
  return "";
}

// The same orders, without what outputs of decoupled blocks say to each other.
ArxOrders chosen_orders(const Subject& subject, const std::vector<Block>& blocks) {
  ArxOrders orders = subject.options.orders;
  for (const Block& block : blocks) {
    if (block.decoupled) orders = decoupled_orders(std::move(orders), block.together.outputs);
  }
  return orders;
}

Result<ArxFit> refit(const Subject& subject, std::vector<Block>& blocks, ArxFit plain) {
  ArxOptions options = subject.options;
  options.orders = chosen_orders(subject, blocks);
  options.first_sample = subject.first_sample();
  const bool decoupled = !(options.orders == subject.options.orders);
  auto learned = learn_rows(subject, subject.recordings, decoupled);
  if (!learned) return learned.error();
  if (decoupled) {
    auto again = fit_arx(subject.recordings, subject.channels, options);
    if (!again) return again.error();
    plain = std::move(*again);
  }
  std::vector<GivenRow> rows;
  for (int i = 0; i < plain.model.orders.outputs(); ++i) {
    rows.push_back(row_of_model(plain.model, i, learned->signals, options.offset));
  }
  bool all = true;
  for (Block& block : blocks) {
    for (const Unit* unit : block.chosen()) {
      const bool refined = !unit->candidates.empty() && unit->refined();
      if (refined) give_refined(subject, *learned, *unit, rows);
      all &= refined;
      if (!go_on(subject.progress, "refining", -1)) return Error{std::string(kStopped)};
    }
  }
  auto fit = fit_with_rows(subject.recordings, subject.channels, options, rows, plain);
  if (!fit || all || !plain.summary.stable.changed) return fit;
  const double radius = fit->summary.stable.radius;
  fit->summary.stable = plain.summary.stable;
  fit->summary.stable.radius = radius;
  return fit;
}

}  // namespace

Result<FocusedFit> focus_fit(std::span<const Recording> recordings, const ChannelChoice& channels,
                             const ArxOptions& options, ArxFit plain, ArxFocus focus, const Progress& progress) {
  const Subject subject{recordings, channels, options, progress};
  std::string why = obstacle(subject, plain, focus);
  FocusedFit out{std::move(plain), false, std::move(why)};
  if (!out.reason.empty()) return out;
  std::vector<Block> blocks = blocks_of(options.orders);
  if (auto ok = judge_folds(subject, blocks); !ok) return ok.error();
  bool judged = false, changed = false;
  for (Block& block : blocks) {
    pick(block, focus);
    changed |= block.decoupled;
    for (const Unit* unit : block.chosen()) {
      judged |= !unit->candidates.empty();
      changed |= !unit->candidates.empty() && unit->refined();
    }
  }
  out.choices = choices_of(blocks);
  out.reason = !judged   ? "too few rows to hold some out"
               : changed ? "held-out free runs are surely better than with least squares"
                         : "held-out free runs are no better than with least squares";
  if (!changed) return out;
  auto fit = refit(subject, blocks, std::move(out.fit));
  if (!fit) return fit.error();
  out.fit = std::move(*fit);
  out.refined = true;
  return out;
}

}  // namespace wisp::arx
