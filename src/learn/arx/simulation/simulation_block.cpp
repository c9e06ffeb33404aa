#include "learn/arx/simulation/simulation_block.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "learn/arx/rows/arx_design.hpp"
#include "learn/numeric/decompositions.hpp"

namespace wisp::arx {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<std::vector<int>> coupled_outputs(const OrderMatrix& na) {
  std::vector<int> label(static_cast<std::size_t>(na.rows()));
  std::iota(label.begin(), label.end(), 0);
  for (bool changed = true; changed;) {
    changed = false;
    for (int i = 0; i < na.rows(); ++i) {
      for (int j = 0; j < na.columns(); ++j) {
        if (na(i, j) == 0 || label[i] == label[j]) continue;
        label[i] = label[j] = std::min(label[i], label[j]);
        changed = true;
      }
    }
  }
  std::vector<std::vector<int>> blocks(label.size());
  for (std::size_t i = 0; i < label.size(); ++i) blocks[label[i]].push_back(static_cast<int>(i));
  std::erase_if(blocks, [](const std::vector<int>& block) { return block.empty(); });
  return blocks;
}

SimulationBlock::SimulationBlock(const Signals& signals, const ArxOrders& orders, std::vector<int> outputs,
                                 bool constant, int first_sample)
    : outputs_(std::move(outputs)), inputs_(signals.inputs), history_(orders.history()) {
  std::vector<LaggedChannel> used;
  memory_.assign(outputs_.size(), 0);
  for (int r = 0; r < size(); ++r) {
    const int output = outputs_[r];
    for (const LaggedChannel& column :
         row_regressors(orders, output, constant ? ArxOffset::kEstimate : ArxOffset::kMean)) {
      BlockTerm term{r, size() + inputs_, column.lag};
      if (column.channel >= signals.outputs) term.channel = size() + column.channel - signals.outputs;
      if (column.channel >= 0 && column.channel < signals.outputs) {
        term.channel = static_cast<int>(std::find(outputs_.begin(), outputs_.end(), column.channel) - outputs_.begin());
        memory_[term.channel] = std::max(memory_[term.channel], column.lag);
      }
      terms_.push_back(term);
      if (column.channel != kConstantChannel) used.push_back(column);
    }
  }
  const LagLayout layout(signals.outputs, signals.inputs, used);
  for (const RowRun& rows : plan_input_rows(signals, layout, first_sample).runs) add_run(signals, rows);
  weight_ = VectorXd::Zero(size());
  for (const BlockRun& run : runs_) {
    for (int o = 0; o < size(); ++o) {
      const auto series = run.outputs.col(o).tail(run.rows).array();
      weight_[o] += series.isNaN().select(0.0, series).square().sum();
      measured_rows_ += static_cast<double>(run.rows - series.isNaN().count());
    }
  }
  weight_ = weight_.unaryExpr([](double energy) { return energy > 0 ? 1 / energy : 0.0; });
}

void SimulationBlock::add_run(const Signals& signals, const RowRun& rows) {
  BlockRun& run = runs_.emplace_back();
  run.rows = static_cast<Index>(rows.end - rows.begin);
  const auto length = run.rows + history_;
  const auto take = [&](int channel) {
    const double* from = signals.samples[rows.recording][channel].data() + rows.begin - history_;
    const Eigen::Map<const VectorXd> samples(from, length);
    return ((samples.array() - signals.offset[channel]) * signals.scale[channel]).matrix().eval();
  };
  run.outputs.resize(length, size());
  run.measured.resize(outputs_.size());
  for (int o = 0; o < size(); ++o) {
    run.outputs.col(o) = take(outputs_[o]);
    for (Index t = history_; t < length; ++t) {
      if (std::isnan(run.outputs(t, o))) continue;
      auto& stretches = run.measured[o];
      const auto row = static_cast<std::size_t>(t);
      if (stretches.empty() || stretches.back().end != row) stretches.push_back({runs_.size() - 1, row, row});
      ++stretches.back().end;
    }
  }
  run.inputs.resize(length, inputs_);
  for (int k = 0; k < inputs_; ++k) {
    const VectorXd samples = take(signals.outputs + k);
    run.inputs.col(k) = samples.array().isNaN().select(0.0, samples);  // no row that is simulated needs those
  }
}

double SimulationBlock::radius(const VectorXd& theta) const {
  const int order = *std::max_element(memory_.begin(), memory_.end());
  if (order == 0) return 0;
  MatrixXd companion = MatrixXd::Zero(Index{order} * size(), Index{order} * size());
  for (std::size_t p = 0; p < terms_.size(); ++p) {
    const BlockTerm& term = terms_[p];
    if (term.channel < size()) companion(term.row, Index{term.lag - 1} * size() + term.channel) = theta[p];
  }
  for (Index r = size(); r < companion.rows(); ++r) companion(r, r - size()) = 1;
  return eigenvalues(companion).cwiseAbs().maxCoeff();
}

bool SimulationBlock::refinable() const {
  bool feedback = false, driven = false;
  for (const BlockTerm& term : terms_) {
    feedback |= term.channel < size();
    driven |= term.channel >= size() && term.channel < size() + inputs_;
  }
  return feedback && driven && !runs_.empty() && (weight_.array() > 0).all();
}

}  // namespace wisp::arx
