#pragma once
// Outputs that feed each other, and the stretches of recordings that their free simulation runs over.

#include <Eigen/Core>
#include <vector>

#include "learn/arx/rows/arx_rows.hpp"
#include "wisp/model/arx.hpp"

namespace wisp::arx {

/// An initial state is told from at most so many rows.
inline constexpr Eigen::Index kMaxStateRows = 4096;

/// Outputs whose rows feed each other, by output; those of different blocks simulate on their own.
std::vector<std::vector<int>> coupled_outputs(const OrderMatrix& na);

/// One coefficient of a block, without A's sign: row `row` takes `channel` at t − lag.
struct BlockTerm {
  int row = 0;      ///< place among the block's outputs
  int channel = 0;  ///< the block's outputs, then all inputs, then the constant
  int lag = 0;
};

/// Rows of one stretch without a gap in the inputs, `history` rows before them included: deviations in scaled units.
struct BlockRun {
  Eigen::Index rows = 0;                      ///< that are simulated
  Eigen::MatrixXd outputs;                    ///< (history + rows) × outputs, NaN where not measured
  Eigen::MatrixXd inputs;                     ///< (history + rows) × inputs
  std::vector<std::vector<RowRun>> measured;  ///< per output, within this run's rows; `recording` is the run's place
};

/// What a free simulation of one block needs, taken out of the recordings.
class SimulationBlock {
 public:
  /// Preconditions: the signals are scaled; `outputs` are one of coupled_outputs(); first_sample >= orders.history().
  SimulationBlock(const Signals& signals, const ArxOrders& orders, std::vector<int> outputs, bool constant,
                  int first_sample);

  const std::vector<int>& outputs() const { return outputs_; }
  int size() const { return static_cast<int>(outputs_.size()); }
  int inputs() const { return inputs_; }
  int history() const { return history_; }
  const std::vector<BlockTerm>& terms() const { return terms_; }
  const std::vector<BlockRun>& runs() const { return runs_; }

  /// Lags of each output that any of the rows remembers.
  const std::vector<int>& memory() const { return memory_; }

  /// 1 over the energy of each measured output.
  const Eigen::VectorXd& weight() const { return weight_; }

  /// Measured samples of all outputs.
  double measured_rows() const { return measured_rows_; }

  /// Largest absolute pole of the terms' A.
  double radius(const Eigen::VectorXd& theta) const;

  /// Whether it has feedback and an input to be driven by.
  bool refinable() const;

 private:
  void add_run(const Signals& signals, const RowRun& rows);

  std::vector<int> outputs_;
  int inputs_ = 0;
  int history_ = 0;
  std::vector<BlockTerm> terms_;
  std::vector<int> memory_;
  std::vector<BlockRun> runs_;
  Eigen::VectorXd weight_;
  double measured_rows_ = 0;
};

}  // namespace wisp::arx
