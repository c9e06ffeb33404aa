#include "learn/arx/simulation/ways.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "learn/arx/fit/given_rows.hpp"
#include "learn/arx/simulation/subspace.hpp"
#include "learn/numeric/decompositions.hpp"

namespace wisp::arx {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kManyRows = 8192;         // more hardly tell more of which way is best:
constexpr std::size_t kRowsOfMany = 4096;       // of them so many decide
constexpr std::size_t kMaxTriedTerms = 24;      // of which every way is tried
constexpr double kFewWeights[] = {10, 1, 0.1};  // tried for more
constexpr int kFewSteps = 15;
constexpr double kFewTolerance = 1e-3;
constexpr int kMaxBatches = 64;
constexpr std::size_t kMinBatchRows = 10;
constexpr int kMaxPolishing = 2;  // steps over all rows, from what some of them say
constexpr int kStates[] = {1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 18, 20, 22, 24, 28, 32, 36, 40};  // tried
constexpr double kNotThere = 1e12;  // squared error of a way that a fold has too few rows for

// More coefficients feed back than are refined together.
bool keeps_feedback(const SimulationBlock& block) { return block.terms().size() > kMaxTerms; }

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

Result<Learned> learn(const Subject& subject, std::span<const Recording> recordings, bool with_decoupled) {
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

OneStepOptions one_step_options(const Subject& subject, const Learned& learned, const Unit& unit) {
  return {.orders = learned.model_of(unit).orders,
          .offset = subject.level(),
          .first_sample = subject.first_sample(),
          .ridge = subject.options.ridge};
}

// How thoroughly a block is worked on.
bool is_expensive(const Subject& subject, const SimulationBlock& block) {
  const std::size_t levels = subject.constant() ? block.outputs().size() : 0;
  return subject.many_rows() || block.terms().size() - levels > kMaxTriedTerms;
}

std::span<const double> weights_for(const Subject& subject, const SimulationBlock& block) {
  if (!subject.refines || !block.refinable()) return {};
  if (!keeps_feedback(block) && is_expensive(subject, block)) return kFewWeights;
  return kOneStepWeights;
}

std::vector<Refined> refine_unit(const Subject& subject, const Learned& learned, const Unit& unit,
                                 const SimulationBlock& block, std::span<const double> weights) {
  const VectorXd squares = least_squares(subject, learned, unit);
  const OneStepLoss loss = one_step_loss(learned.signals, block, one_step_options(subject, learned, unit));
  if (keeps_feedback(block)) return drive_path(block, loss, squares, weights);
  const bool few = is_expensive(subject, block);
  RefineOptions options;
  if (few) options.steps = kFewSteps, options.tolerance = kFewTolerance;
  options.go_on = [&] { return go_on(subject.progress, "refining", -1); };
  std::vector<VectorXd> starts{squares};
  if (!few) {
    for (const auto& more :
         {other_starts(block, squares),
          cancelling_starts(learned.signals, block, one_step_options(subject, learned, unit), options)}) {
      starts.insert(starts.end(), more.begin(), more.end());
    }
  }
  return refined_path(block, loss, starts, weights, options);
}

// What takes rows about zero to rows about means that simulate the same.
struct Shift {
  MatrixXd turn;
  VectorXd added;

  VectorXd operator()(const VectorXd& theta) const { return turn * theta + added; }
};

Shift shift_to_means(const SimulationBlock& zero, const Signals& from, const SimulationBlock& block,
                     const Signals& to) {
  const auto channel_of = [&](int channel) {
    return std::size_t(channel < block.size() ? block.outputs()[std::size_t(channel)]
                                              : to.outputs + channel - block.size());
  };
  const auto size = Index(block.terms().size());
  Shift out{MatrixXd::Zero(size, Index(zero.terms().size())), VectorXd::Zero(size)};
  for (Index q = 0; q < size; ++q) {
    const BlockTerm& term = block.terms()[std::size_t(q)];
    const std::size_t output = channel_of(term.row);
    const bool constant = term.channel == block.size() + block.inputs();
    if (constant) out.added[q] = -to.scale[output] * to.offset[output];
    for (Index p = 0; p < out.turn.cols(); ++p) {
      const BlockTerm& own = zero.terms()[std::size_t(p)];
      const std::size_t channel = channel_of(own.channel);
      const double in_units = from.scale[channel] / from.scale[output];
      if (constant && own.row == term.row) out.turn(q, p) = to.scale[output] * in_units * to.offset[channel];
      const bool same = own.row == term.row && own.channel == term.channel && own.lag == term.lag;
      if (same && to.scale[channel] > 0) out.turn(q, p) = in_units * to.scale[output] / to.scale[channel];
    }
  }
  return out;
}

// What is refined, for every weight of one step. `means` is the same about means.
void add_refined(const Subject& subject, const Learned& learned, const Unit& unit, const Learned& means,
                 const SimulationBlock& about_means, std::vector<Way>& ways) {
  const SimulationBlock block = simulation_of(subject, learned.signals, learned, unit);
  const auto weights = weights_for(subject, block);
  const bool at_zero = &learned != &means;
  if (weights.empty() || (at_zero && is_expensive(subject, block))) return;
  std::vector<Refined> path = refine_unit(subject, learned, unit, block, weights);
  std::optional<Shift> shift;
  if (at_zero) shift = shift_to_means(block, learned.signals, about_means, means.signals);
  const ArxOrders& orders = learned.model_of(unit).orders;
  for (std::size_t w = 0; w < path.size(); ++w) {
    VectorXd& theta = path[w].simulation.theta;
    if (shift) theta = (*shift)(theta);
    ways.push_back(
        {{.one_step_weight = weights[w], .at_zero = at_zero, .decoupled = unit.decoupled}, orders, std::move(theta)});
  }
}

void add_state_spaces(const Subject& subject, const Learned& learned, const Unit& unit, std::vector<Way>& ways) {
  const int outputs = static_cast<int>(unit.outputs.size());
  const bool constant = subject.options.offset == ArxOffset::kEstimate;
  const Subspace subspace(learned.signals, unit.outputs, constant);
  for (int states : kStates) {
    if (states > (kStateSpaceLags - 1) * outputs) break;
    const int lags = arx_lags(states, outputs);
    Way& way = ways.emplace_back(Way{{.states = states, .decoupled = unit.decoupled},
                                     state_space_orders(subject.options.orders, unit.outputs, lags)});
    if (subspace.max_states() > 0) way.space = subspace.model(states, subject.largest_pole());
    if (way.space) way.form = arx_form(*way.space, lags);
    if (way.space && !(radius(way.form) < 1)) way.space.reset();
  }
}

void add_kernels(const Subject& subject, const Learned& learned, const Unit& unit, std::vector<Way>& ways) {
  const auto& kernels = learned.kernels_of(unit);
  for (std::size_t k = 0; k < kernels.size(); ++k) {
    Way& way = ways.emplace_back(
        Way{{.kernel_lags = subject.kernel_lags[k], .decoupled = unit.decoupled}, subject.options.orders});
    if (!kernels[k]) continue;
    way.orders = kernels[k]->model.orders;
    way.theta = theta_of(subject, learned, kernels[k]->model, unit);
  }
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
  return symmetric_solutions(model.curvature, symmetric_solutions(model.curvature, scatter).transpose());
}

// The best for all rows: of many, from what is best for some of them.
Refined best_of(const Subject& subject, const Learned& learned, const Unit& unit, const SimulationBlock& block,
                const OneStepLoss& loss) {
  const double weight = *unit.candidates[unit.picked].one_step_weight;
  if (!subject.many_rows() || keeps_feedback(block)) {
    return refine_unit(subject, learned, unit, block, {&weight, 1}).front();
  }
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

}  // namespace

bool Subject::many_rows() const {
  std::size_t rows = 0;
  for (const Recording& one : recordings) rows += one.rows();
  return rows > kManyRows;
}

std::vector<Recording> Subject::some_rows() const {
  return middles_of(recordings, many_rows() ? kRowsOfMany : kManyRows);
}

int Subject::judged_from() const {
  const int most = kernel_lags.empty() ? 0 : kernel_orders(options.orders, kernel_lags.back()).history();
  return std::max({first_sample(), most, subspace ? kStateSpaceLags : 0});
}

Subject Subject::about_zero() const {
  Subject out = *this;
  out.options.offset = ArxOffset::kNone;
  out.subspace = false;
  return out;
}

bool Subject::has_one_state(const Unit& unit) const {
  return std::all_of(unit.outputs.begin(), unit.outputs.end(), [&](int i) {
    for (int j : unit.outputs) {
      if (options.orders.na(i, j) == 0) return false;
    }
    for (int k = 0; k < options.orders.inputs(); ++k) {
      if (options.orders.nb(i, k) == 0) return false;
    }
    return true;
  });
}

bool lie_off_zero(std::span<const Recording> recordings, const ChannelChoice& channels) {
  const auto is_off_zero = [&](const std::string& name) {
    double sum = 0, square = 0, rows = 0;
    for (const Recording& recording : recordings) {
      for (double x : recording.channels[*find_channel(recording, name)].samples) {
        if (!std::isnan(x)) sum += x, square += x * x, ++rows;
      }
    }
    return 2 * sum * sum > square * rows;  // mean² > variance
  };
  return std::all_of(channels.inputs.begin(), channels.inputs.end(), is_off_zero) &&
         std::all_of(channels.outputs.begin(), channels.outputs.end(), is_off_zero);
}

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

ArxOrders decoupled_orders(ArxOrders orders, const std::vector<int>& outputs) {
  for (int i : outputs) {
    for (int j : outputs) {
      if (i != j) orders.na(i, j) = 0;
    }
  }
  return orders;
}

SimulationBlock simulation_of(const Subject& subject, const Signals& signals, const Learned& learned,
                              const Unit& unit) {
  return SimulationBlock(signals, learned.model_of(unit).orders, unit.outputs, subject.constant(),
                         subject.first_sample());
}

Result<LearnedRows> learn_rows(const Subject& subject, std::span<const Recording> recordings, bool with_decoupled) {
  auto given = learn(subject, recordings, with_decoupled);
  if (!given) return given.error();
  LearnedRows out{std::move(*given)};
  if (!subject.at_zero) return out;
  Subject about_zero = subject.about_zero();
  about_zero.kernel_lags.clear();
  auto zero = learn(about_zero, recordings, with_decoupled);
  if (!zero) return zero.error();
  out.at_zero = std::move(*zero);
  return out;
}

std::vector<Way> ways_of(const Subject& subject, const LearnedRows& rows, const Unit& unit) {
  const Learned& learned = rows.given;
  const SimulationBlock seen = simulation_of(subject, learned.signals, learned, unit);
  std::vector<Way> ways{
      {{.decoupled = unit.decoupled}, learned.model_of(unit).orders, least_squares(subject, learned, unit)}};
  add_refined(subject, learned, unit, learned, seen, ways);
  if (rows.at_zero) add_refined(subject.about_zero(), *rows.at_zero, unit, learned, seen, ways);
  add_kernels(subject, learned, unit, ways);
  const bool several = unit.outputs.size() > 1;
  if (several && subject.subspace && subject.has_one_state(unit)) add_state_spaces(subject, learned, unit, ways);
  return ways;
}

HeldOutErrors errors_of(const Subject& subject, const Signals& held_out, const Unit& unit, const Way& way,
                        const SimulationBlock& unseen) {
  if (!way.is_there()) {
    const VectorXd none = VectorXd::Constant(kParts, kNotThere);
    return {none, none, 0, VectorXd::Constant(Index(unit.outputs.size()), kNotThere)};
  }
  if (way.candidate.kernel_lags == 0 && way.candidate.states == 0) return held_out_errors(unseen, way.theta);
  const SimulationBlock block(held_out, way.orders, unit.outputs, subject.constant(), subject.judged_from());
  return way.space ? held_out_errors(block, *way.space, way.form) : held_out_errors(block, way.theta);
}

RefinedRows refined_rows(const Subject& subject, const LearnedRows& rows, const Unit& unit) {
  const FocusCandidate& chosen = unit.candidates[unit.picked];
  const Subject own = chosen.at_zero ? subject.about_zero() : subject;
  const Learned& learned = chosen.at_zero ? *rows.at_zero : rows.given;
  const SimulationBlock block = simulation_of(own, learned.signals, learned, unit);
  const OneStepLoss loss = one_step_loss(learned.signals, block, one_step_options(own, learned, unit));
  const Refined best = best_of(own, learned, unit, block, loss);
  RefinedRows out{best.simulation.theta};
  if (!keeps_feedback(block)) out.covariance = covariance_of(block, loss, best, learned.coupled.summary.samples_used);
  if (chosen.at_zero) {
    const SimulationBlock means = simulation_of(subject, rows.given.signals, rows.given, unit);
    const Shift shift = shift_to_means(block, learned.signals, means, rows.given.signals);
    out.theta = shift(out.theta);
    out.covariance = shift.turn * out.covariance * shift.turn.transpose();
  }
  return out;
}

}  // namespace wisp::arx
