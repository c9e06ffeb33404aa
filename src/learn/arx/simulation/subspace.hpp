#pragma once
// State-space models of some outputs by subspace identification.
//
// Source: M. Verhaegen, Automatica 30 (1994) (PO-MOESP: the past of inputs and outputs is the instrument); P. Van
// Overschee and B. De Moor, Subspace Identification for Linear Systems (1996), chapter 4; for the inputs' part given
// the poles, L. Ljung, System Identification (2nd ed.), section 10.6: it is linear in what is sought, so it minimises
// the error of free simulation. Departures: the projections are taken from the Gram matrix of lagged channels, whose
// rows cross no gap, and poles outside the unit circle are mirrored into it.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "learn/arx/rows/arx_rows.hpp"
#include "learn/arx/simulation/state_space.hpp"

namespace wisp::arx {

/// What models of every number of states have in common.
class Subspace {
 public:
  /// `constant`: whether outputs have a level that is estimated. Precondition: the signals are scaled.
  Subspace(const Signals& signals, const std::vector<int>& outputs, bool constant);

  /// 0 where rows are too few, or a channel never moves.
  int max_states() const { return static_cast<int>(strength_.size()); }

  /// Of min(states, max_states()) states, stable with all poles within `most` that were not within the unit circle.
  /// Nothing where there is none. Precondition: states > 0.
  std::optional<StateSpace> model(int states, double most) const;

 private:
  void find_observability(const Signals& signals);

  SimulationBlock block_;
  bool constant_;
  int horizon_ = 0;            // rows of the past, and of the future that they tell
  Eigen::MatrixXd direction_;  // of the states' effect on `horizon_` rows, a column each, the strongest first
  Eigen::VectorXd strength_;
  Eigen::VectorXd noise_;
};

}  // namespace wisp::arx
