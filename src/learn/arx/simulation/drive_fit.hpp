#pragma once
// The inputs' part of a state-space system whose poles and outputs are known.

#include <Eigen/Core>

#include "learn/arx/simulation/simulation_block.hpp"
#include "learn/numeric/decompositions.hpp"

namespace wisp::arx {

struct Drive {
  Eigen::MatrixXcd b;     ///< in modal coordinates, states × inputs
  Eigen::MatrixXd d;      ///< outputs × inputs
  Eigen::VectorXd level;  ///< per output, 0 where no constant is estimated
};

/// With which free simulation is nearest to what was measured, from the initial states that fit best. Rows in which an
/// output is missing do not count. `modes` are the poles, `shapes` (outputs × modes) what outputs see of them; both
/// come in conjugate pairs.
Drive fit_drive(const SimulationBlock& block, const Eigen::VectorXcd& modes, const Eigen::MatrixXcd& shapes,
                bool constant);

}  // namespace wisp::arx
