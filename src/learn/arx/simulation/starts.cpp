// Where to descend from, for a block of one output.

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "learn/arx/simulation/refine.hpp"
#include "learn/numeric/decompositions.hpp"
#include "learn/numeric/lag_gram.hpp"

namespace wisp::arx {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Output, simulated output and inputs of all runs through 1/A.
class FilteredRuns {
 public:
  FilteredRuns(const SimulationBlock& block, const VectorXd& theta) {
    const Index pad = block.memory().front();
    const BlockSimulation simulation = simulate_block(block, theta);
    for (std::size_t r = 0; r < block.runs().size(); ++r) {
      const BlockRun& run = block.runs()[r];
      MatrixXd series = MatrixXd::Zero(pad + block.history() + run.rows, 2 + block.inputs());
      auto rows = series.bottomRows(series.rows() - pad);
      const auto measured = run.outputs.col(0).array();
      rows.col(0) = measured.isNaN().select(simulation.simulated[r].col(0).array(), measured);
      rows.col(1) = simulation.simulated[r].col(0);
      rows.rightCols(block.inputs()) = run.inputs;
      filter_by_feedback(block, theta, series);
      series_.push_back(series.bottomRows(series.rows() - pad));
    }
    std::vector<LaggedChannel> used;
    for (const BlockTerm& term : block.terms()) {
      const bool own = term.channel == 0;
      if (term.channel == 1 + block.inputs()) continue;
      used.push_back({own ? 0 : 1 + term.channel, term.lag});
      if (own) used.push_back({1, term.lag});
    }
    const LagLayout layout(1, 1 + block.inputs(), used);
    Signals signals;
    RowPlan plan;
    for (const MatrixXd& one : series_) {
      plan.runs.push_back(
          {signals.samples.size(), static_cast<std::size_t>(block.history()), static_cast<std::size_t>(one.rows())});
      auto& samples = signals.samples.emplace_back();
      for (Index c = 0; c < one.cols(); ++c) {
        samples.emplace_back(one.col(c).data(), static_cast<std::size_t>(one.rows()));
      }
    }
    signals.outputs = 1;
    signals.inputs = 1 + block.inputs();
    signals.offset.assign(std::size_t(2 + block.inputs()), 0.0);
    signals.scale.assign(std::size_t(2 + block.inputs()), 1.0);
    signals.missing = false;
    gram_ = lag_gram(signals, plan, layout, ChannelPairs::Constant(layout.channels(), layout.channels(), true));
    for (const BlockTerm& term : block.terms()) {
      const bool own = term.channel == 0, constant = term.channel == 1 + block.inputs();
      const int channel = constant ? kConstantChannel : own ? 0 : 1 + term.channel;
      regressors_.push_back(layout.find({channel, term.lag}));
      instruments_.push_back(layout.find({own ? 1 : channel, term.lag}));
    }
    target_ = layout.target(0);
  }

  VectorXd solve(bool instruments) const {
    const std::vector<int>& left = instruments ? instruments_ : regressors_;
    const MatrixXd products = gram_(left, regressors_);
    const VectorXd moment = gram_.col(target_)(left);
    return shortest_solution(products, moment);
  }

 private:
  std::vector<MatrixXd> series_;
  MatrixXd gram_;
  std::vector<int> regressors_;
  std::vector<int> instruments_;
  int target_ = 0;
};

// Every order less by one; nothing where one of them is below 2.
std::optional<ArxOrders> lowered(ArxOrders orders, int output) {
  if (orders.na(output, output) < 2) return std::nullopt;
  --orders.na(output, output);
  for (int k = 0; k < orders.inputs(); ++k) {
    if (orders.nb(output, k) == 1) return std::nullopt;
    if (orders.nb(output, k) > 0) --orders.nb(output, k);
  }
  return orders;
}

// A lower block's coefficients as the block's, A, B and the constant times 1 − pole q⁻¹.
VectorXd with_cancelling_pole(const SimulationBlock& block, const SimulationBlock& lower, const VectorXd& theta,
                              double pole) {
  const int constant = block.size() + block.inputs();
  const auto value = [&](int channel, int lag) {
    if (channel == 0 && lag == 0) return -1.0;
    for (std::size_t p = 0; p < lower.terms().size(); ++p) {
      if (lower.terms()[p].channel == channel && lower.terms()[p].lag == lag) return theta[Index(p)];
    }
    return 0.0;
  };
  VectorXd out(Index(block.terms().size()));
  for (std::size_t p = 0; p < block.terms().size(); ++p) {
    const BlockTerm& term = block.terms()[p];
    const int before = term.channel == constant ? term.lag : term.lag - 1;
    out[Index(p)] = value(term.channel, term.lag) - pole * value(term.channel, before);
  }
  return out;
}

}  // namespace

std::vector<VectorXd> other_starts(const SimulationBlock& block, const VectorXd& squares) {
  constexpr int kInstrumentSteps = 4, kFilterSteps = 12;
  std::vector<VectorXd> starts;
  if (block.size() != 1) return starts;
  for (bool instruments : {true, false}) {
    VectorXd theta = drawn_in(block, squares, kStartRadius);
    for (int step = 0; step < (instruments ? kInstrumentSteps : kFilterSteps); ++step) {
      const VectorXd next = drawn_in(block, FilteredRuns(block, theta).solve(instruments), kStartRadius);
      if (!next.allFinite()) break;
      theta = next;
    }
    starts.push_back(std::move(theta));
  }
  return starts;
}

std::vector<VectorXd> cancelling_starts(const Signals& signals, const SimulationBlock& block,
                                        const OneStepOptions& options, const RefineOptions& how) {
  constexpr double kPoles[] = {0.9, 0.99};  // forgotten within 10 rows, and within 100
  std::vector<VectorXd> starts;
  if (block.size() != 1) return starts;
  const auto orders = lowered(options.orders, block.outputs().front());
  if (!orders) return starts;
  const bool constant = options.offset == ArxOffset::kEstimate;
  const SimulationBlock lower(signals, *orders, block.outputs(), constant, options.first_sample);
  const OneStepLoss loss = one_step_loss(
      signals, lower,
      {.orders = *orders, .offset = options.offset, .first_sample = options.first_sample, .ridge = options.ridge});
  const Refined best = refine(lower, loss, loss.best, how);
  for (double pole : kPoles) starts.push_back(with_cancelling_pole(block, lower, best.simulation.theta, pole));
  return starts;
}

}  // namespace wisp::arx
