#pragma once
// The squared error of free simulation as a function of an ARX model's coefficients, with its Gauss–Newton model.
//
// Source: L. Ljung, System Identification (2nd ed.), sections 4.2 (output error), 10.2 (gradients by filtering), G.
// Golub and V. Pereyra, Inverse Problems 19 (2003), for the elimination of the initial states (variable projection). An
// initial state is given as shocks to the first rows of a stretch, which reach the same outputs and need no past.

#include <Eigen/Core>
#include <vector>

#include "learn/arx/simulation/simulation_block.hpp"

namespace wisp::arx {

/// A free simulation of a block with given coefficients, and its error.
struct BlockSimulation {
  Eigen::VectorXd theta;
  std::vector<Eigen::MatrixXd> simulated;  ///< per run, (history + rows) × outputs
  std::vector<Eigen::MatrixXd> error;      ///< measured − simulated; 0 where not measured
  Eigen::MatrixXd shock;                   ///< response of output o to a shock to row i: column i·outputs + o
  double cost = 0;                         ///< Σ weight error²
};

/// Simulates from the initial states that fit best.
BlockSimulation simulate_block(const SimulationBlock& block, const Eigen::VectorXd& theta);

/// One run from row `begin` of it on, counted with its history, from measured samples.
Eigen::MatrixXd simulate_from(const SimulationBlock& block, const Eigen::VectorXd& theta, const BlockRun& run,
                              Eigen::Index begin);

/// cost(θ + δ) ≈ cost − 2 gradientᵀδ + δᵀ curvature δ, the initial states following.
struct GaussNewton {
  Eigen::MatrixXd curvature;
  Eigen::VectorXd gradient;
};

GaussNewton gauss_newton(const SimulationBlock& block, const BlockSimulation& at);

/// The same of some of the block's terms, the others as they are.
GaussNewton gauss_newton(const SimulationBlock& block, const BlockSimulation& at, const std::vector<BlockTerm>& moved);

/// Each column through 1/A, from row memory on; the rows before are its past.
///
/// Precondition: the block has one output.
void filter_by_feedback(const SimulationBlock& block, const Eigen::VectorXd& theta, Eigen::MatrixXd& columns);

/// The gradient over `batches` equal shares of the rows, a column each: their scatter is that of the gradient, whatever
/// the error's colour.
Eigen::MatrixXd batch_gradients(const SimulationBlock& block, const BlockSimulation& at, int batches);

}  // namespace wisp::arx
