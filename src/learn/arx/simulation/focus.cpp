#include "learn/arx/simulation/focus.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "learn/arx/fit/given_rows.hpp"
#include "learn/arx/rows/arx_rows.hpp"
#include "learn/arx/simulation/focus_choice.hpp"
#include "learn/arx/simulation/held_out.hpp"
#include "learn/arx/simulation/refine.hpp"
#include "learn/arx/simulation/state_space.hpp"
#include "learn/arx/simulation/subspace.hpp"
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
constexpr int kMaxBatches = 64;
constexpr std::size_t kMinBatchRows = 10;
constexpr int kMaxPolishing = 2;  // steps over all rows, from what some of them say
constexpr int kStates[] = {1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 18, 20, 22, 24, 28, 32, 36, 40};  // tried
constexpr const char* kRankless = "the data cannot tell all coefficients";
constexpr double kNotThere = 1e12;  // squared error of a way that a fold has too few rows for

ArxOrders kernel_orders(ArxOrders orders, int lags) {
  for (int i = 0; i < orders.outputs(); ++i) {
    for (int j = 0; j < orders.outputs(); ++j) {
      if (orders.na(i, j) > 0) orders.na(i, j) = std::max(orders.na(i, j), lags);
    }
    for (int k = 0; k < orders.inputs(); ++k) {
      if (orders.nb(i, k) == 0) continue;
      orders.nb(i, k) = std::max(orders.nb(i, k) + orders.nk(i, k), lags);
      orders.nk(i, k) = 0;
    }
  }
  return orders;
}

// Of what a subspace estimate gives: every output remembers all that it is simulated with.
ArxOrders state_space_orders(ArxOrders orders, const std::vector<int>& outputs, int lags) {
  for (int i : outputs) {
    for (int j : outputs) orders.na(i, j) = lags;
    for (int k = 0; k < orders.inputs(); ++k) {
      orders.nb(i, k) = lags + 1;
      orders.nk(i, k) = 0;
    }
  }
  return orders;
}

// The arguments of a fit, and what may be tried.
struct Subject {
  std::span<const Recording> recordings;
  const ChannelChoice& channels;
  const ArxOptions& options;
  const Progress& progress;
  std::vector<int> kernel_lags{};  // that are tried
  bool subspace = false;           // the same of subspace estimates
  bool refines = true;             // whether the data tell all coefficients; if not, only a state can

  bool many_rows() const {
    std::size_t rows = 0;
    for (const Recording& one : recordings) rows += one.rows();
    return rows > kManyRows;
  }
  std::vector<Recording> some_rows() const { return middles_of(recordings, many_rows() ? kRowsOfMany : kManyRows); }
  int first_sample() const { return options.first_sample.value_or(options.orders.history()); }
  int judged_from() const {
    const int most = kernel_lags.empty() ? 0 : kernel_orders(options.orders, kernel_lags.back()).history();
    return std::max({first_sample(), most, subspace ? kStateSpaceLags : 0});
  }

  // The mean of a slow output is not where its inputs' means bring it: free runs show it, one step hardly does.
  ArxOffset level() const { return options.offset == ArxOffset::kMean ? ArxOffset::kEstimate : options.offset; }
  bool constant() const { return level() == ArxOffset::kEstimate; }

  // A state is in common, reaches all outputs and is driven by all inputs.
  bool tries_states(const Unit& unit) const {
    const auto driven = [&](int i) {
      for (int j : unit.outputs) {
        if (options.orders.na(i, j) == 0) return false;
      }
      for (int k = 0; k < options.orders.inputs(); ++k) {
        if (options.orders.nb(i, k) == 0) return false;
      }
      return true;
    };
    return subspace && unit.outputs.size() > 1 && std::all_of(unit.outputs.begin(), unit.outputs.end(), driven);
  }
  double largest_pole() const { return 1 - options.stability_margin; }
};

// Least squares for some rows.
struct Learned {
  Signals signals;
  ArxFit coupled;
  std::optional<ArxFit> decoupled{};
  std::vector<std::optional<ArxFit>> kernels{};  // by the lags that are tried; nothing where rows do not suffice
  std::vector<std::optional<ArxFit>> decoupled_kernels{};

  const ArxModel& model_of(const Unit& unit) const { return unit.decoupled ? decoupled->model : coupled.model; }
  const std::vector<std::optional<ArxFit>>& kernels_of(const Unit& unit) const {
    return unit.decoupled ? decoupled_kernels : kernels;
  }
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

std::vector<std::optional<ArxFit>> under_kernels(const Subject& subject, std::span<const Recording> recordings,
                                                 const ArxOptions& given) {
  std::vector<std::optional<ArxFit>> kernels;
  for (int lags : subject.kernel_lags) {
    ArxOptions options = given;
    options.orders = kernel_orders(given.orders, lags);
    options.first_sample = std::max(*given.first_sample, options.orders.history());
    options.offset = subject.level();
    options.kernel = ArxKernel::kTc;
    auto fit = fit_arx(recordings, subject.channels, options);
    kernels.push_back(fit ? std::optional<ArxFit>(std::move(*fit)) : std::nullopt);  // too few rows for as many lags
  }
  return kernels;
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
  learned.kernels = under_kernels(subject, recordings, options);
  if (!with_decoupled) return learned;
  std::vector<int> all(subject.channels.outputs.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  options.orders = decoupled_orders(options.orders, all);
  auto decoupled = fit_arx(recordings, subject.channels, options);
  if (!decoupled) return decoupled.error();
  learned.decoupled = std::move(*decoupled);
  learned.decoupled_kernels = under_kernels(subject, recordings, options);
  return learned;
}

SimulationBlock simulation_of(const Subject& subject, const Signals& signals, const ArxOrders& orders, const Unit& unit,
                              int first_sample) {
  return SimulationBlock(signals, orders, unit.outputs, subject.constant(), first_sample);
}

SimulationBlock simulation_of(const Subject& subject, const Signals& signals, const Learned& learned,
                              const Unit& unit) {
  return simulation_of(subject, signals, learned.model_of(unit).orders, unit, subject.first_sample());
}

VectorXd theta_of(const Subject& subject, const Learned& learned, const ArxModel& model, const Unit& unit) {
  std::vector<double> theta;
  for (int output : unit.outputs) {
    const GivenRow row = row_of_model(model, output, learned.signals, subject.level());
    theta.insert(theta.end(), row.theta.begin(), row.theta.end());
  }
  return Eigen::Map<const VectorXd>(theta.data(), Index(theta.size()));
}

VectorXd least_squares(const Subject& subject, const Learned& learned, const Unit& unit) {
  return theta_of(subject, learned, learned.model_of(unit), unit);
}

// How thoroughly a block is worked on.
bool is_expensive(const Subject& subject, const SimulationBlock& block) {
  const std::size_t levels = subject.constant() ? block.outputs().size() : 0;
  return subject.many_rows() || block.terms().size() - levels > kMaxTriedTerms;
}

std::span<const double> weights_for(const Subject& subject, const SimulationBlock& block) {
  if (!block.refinable() || block.terms().size() > kMaxTerms) return {};
  if (is_expensive(subject, block)) return kFewWeights;
  return kOneStepWeights;
}

std::vector<Refined> refine_unit(const Subject& subject, const Learned& learned, const Unit& unit,
                                 const SimulationBlock& block, std::span<const double> weights) {
  const VectorXd squares = least_squares(subject, learned, unit);
  const OneStepLoss loss =
      one_step_loss(learned.signals, block, learned.model_of(unit).orders, subject.level(), subject.first_sample());
  const bool few = is_expensive(subject, block);
  std::vector<VectorXd> starts;
  if (!few) starts = other_starts(block, squares);
  starts.insert(starts.begin(), squares);
  RefineOptions options;
  if (few) options.steps = kFewSteps, options.tolerance = kFewTolerance;
  options.go_on = [&] { return go_on(subject.progress, "refining", -1); };
  return refined_path(block, loss, starts, weights, options);
}

// A way to go, and what it gives for a fold's rows.
struct Way {
  FocusCandidate candidate;
  ArxOrders orders;
  VectorXd theta;
  std::optional<StateSpace> space{};
  ArxForm form{};  // of the space
};

void add_state_spaces(const Subject& subject, const Learned& learned, const Unit& unit, std::vector<Way>& ways) {
  const int outputs = static_cast<int>(unit.outputs.size());
  const bool constant = subject.options.offset == ArxOffset::kEstimate;
  const Subspace subspace(learned.signals, unit.outputs, constant);
  for (int states : kStates) {
    if (states > (kStateSpaceLags - 1) * outputs) break;
    Way& way = ways.emplace_back(Way{{.states = states, .decoupled = unit.decoupled}, subject.options.orders, {}});
    if (subspace.max_states() > 0) way.space = subspace.model(states, subject.largest_pole());
    if (way.space) way.form = arx_form(*way.space, arx_lags(states, outputs));
    if (way.space && !(radius(way.form) < 1)) way.space.reset();
  }
}

// Least squares first, then what lies farther and farther from it.
std::vector<Way> ways_of(const Subject& subject, const Learned& learned, const Unit& unit) {
  const SimulationBlock seen = simulation_of(subject, learned.signals, learned, unit);
  const ArxModel& model = learned.model_of(unit);
  std::vector<Way> ways{{{.decoupled = unit.decoupled}, model.orders, least_squares(subject, learned, unit)}};
  const auto weights = weights_for(subject, seen);
  if (subject.refines && !weights.empty()) {
    std::vector<Refined> path = refine_unit(subject, learned, unit, seen, weights);
    for (std::size_t w = 0; w < path.size(); ++w) {
      ways.push_back({{.one_step_weight = weights[w], .decoupled = unit.decoupled},
                      model.orders,
                      std::move(path[w].simulation.theta)});
    }
  }
  const auto& kernels = learned.kernels_of(unit);
  for (std::size_t k = 0; k < kernels.size(); ++k) {
    Way& way = ways.emplace_back(
        Way{{.kernel_lags = subject.kernel_lags[k], .decoupled = unit.decoupled}, subject.options.orders, {}});
    if (!kernels[k]) continue;
    way.orders = kernels[k]->model.orders;
    way.theta = theta_of(subject, learned, kernels[k]->model, unit);
  }
  if (subject.tries_states(unit)) add_state_spaces(subject, learned, unit, ways);
  return ways;
}

HeldOutErrors errors_of(const Subject& subject, const Signals& held_out, const Unit& unit, const Way& way,
                        const SimulationBlock& unseen) {
  const int states = way.candidate.states;
  if (states > 0 ? !way.space : way.theta.size() == 0) {
    const VectorXd none = VectorXd::Constant(kParts, kNotThere);
    return {none, none, 0, VectorXd::Constant(Index(unit.outputs.size()), kNotThere)};
  }
  if (way.candidate.kernel_lags == 0 && states == 0) return held_out_errors(unseen, way.theta);
  const int lags = arx_lags(states, static_cast<int>(unit.outputs.size()));
  const ArxOrders orders = states > 0 ? state_space_orders(way.orders, unit.outputs, lags) : way.orders;
  const SimulationBlock block = simulation_of(subject, held_out, orders, unit, subject.judged_from());
  return states > 0 ? held_out_errors(block, *way.space, way.form) : held_out_errors(block, way.theta);
}

// Adds what a fold says of every way to go.
void judge_unit(const Subject& subject, const Learned& learned, const Signals& held_out, Unit& unit) {
  const SimulationBlock unseen =
      simulation_of(subject, held_out, learned.model_of(unit).orders, unit, subject.judged_from());
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
  const OneStepLoss loss =
      one_step_loss(learned.signals, block, learned.model_of(unit).orders, subject.level(), subject.first_sample());
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
  if (focus == ArxFocus::kPrediction) return "one step ahead, as asked for";
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

// The rows of one unit as chosen, learned from all rows. Returns whether they are other than least squares'.
bool give_chosen(const Subject& subject, const Learned& learned, const Unit& unit, std::vector<GivenRow>& rows,
                 ArxFit& plain) {
  if (unit.states() > 0) return give_state_space(subject, learned, unit, rows);
  if (unit.refined()) give_refined(subject, learned, unit, rows);
  if (unit.kernel_lags() == 0) return unit.refined();
  const auto tried = std::find(subject.kernel_lags.begin(), subject.kernel_lags.end(), unit.kernel_lags());
  const ArxModel& kernel = learned.kernels_of(unit)[std::size_t(tried - subject.kernel_lags.begin())]->model;
  for (int output : unit.outputs) {
    rows[std::size_t(output)] = row_of_model(kernel, output, learned.signals, subject.level());
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
    rows.push_back(row_of_model(plain.model, i, learned->signals, subject.level()));
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
bool many_lags_are_tried(std::span<const Recording> recordings, const ArxOptions& options, ArxFocus focus, int lags) {
  if (focus != ArxFocus::kAuto || options.ridge > 0) return false;
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
                             const ArxOptions& options, ArxFit plain, ArxFocus focus, const Progress& progress) {
  const bool refines = plain.summary.rank_problems.empty();
  const bool states = many_lags_are_tried(recordings, options, focus, kKernelLags[0]);
  Subject subject{recordings, channels, options, progress, {}, states, refines};
  for (int lags : kKernelLags) {
    const bool tried = refines && many_lags_are_tried(recordings, options, focus, lags);
    if (tried && kernel_has_time(subject, lags)) subject.kernel_lags.push_back(lags);
  }
  std::string why = obstacle(subject, focus);
  FocusedFit out{std::move(plain), false, std::move(why)};
  if (!out.reason.empty()) return out;
  std::vector<Block> blocks = blocks_of(options.orders);
  if (auto ok = judge_folds(subject, blocks); !ok) return ok.error();
  bool judged = false, changed = false;
  for (Block& block : blocks) {
    block.pick(focus == ArxFocus::kSimulation);
    changed |= block.decoupled;
    for (const Unit* unit : block.chosen()) {
      judged |= !unit->candidates.empty();
      changed |= unit->picked > 0;
    }
  }
  out.choices = choices_of(blocks);
  out.reason = !judged    ? "too few rows to hold some out"
               : changed  ? "held-out free runs are surely better than with least squares"
               : !refines ? kRankless
                          : "held-out free runs are no better than with least squares";
  if (!changed) return out;
  auto fit = refit(subject, blocks, std::move(out.fit));
  if (!fit) return fit.error();
  out.fit = std::move(*fit);
  out.refined = true;
  return out;
}

}  // namespace wisp::arx
