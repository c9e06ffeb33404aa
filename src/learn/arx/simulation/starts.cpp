// Steiglitz–McBride's and instrumental variables' estimates of a block of one output.

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "learn/arx/simulation/refine.hpp"
#include "learn/numeric/decompositions.hpp"
#include "learn/numeric/lag_gram.hpp"

namespace wisp::arx {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kStartRadius = 0.999;

// Output, simulated output and inputs of all runs through 1/A.
class FilteredRuns {
 public:
  FilteredRuns(const SimulationBlock& block, const VectorXd& theta) : block_(block) {
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
  const SimulationBlock& block_;
  std::vector<MatrixXd> series_;
  MatrixXd gram_;
  std::vector<int> regressors_;
  std::vector<int> instruments_;
  int target_ = 0;
};

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

}  // namespace wisp::arx
