#pragma once
// From least squares towards free simulation: coefficients that lessen the error of free runs, with more or less weight
// left on the error one step ahead.
//
// Source: K. Levenberg, D. Marquardt (J. Nocedal and S. Wright, Numerical Optimization, section 10.3); starts as in
// K. Steiglitz and L. McBride, IEEE Trans. Autom. Control 10 (1965), and by instrumental variables (L. Ljung, System
// Identification, section 7.6). The weight on one step keeps what free runs hardly see (poles that nearly cancel zeros)
// where the next sample says it is, so that a simulation that starts at measured samples does not excite it.

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "learn/arx/rows/arx_design.hpp"
#include "learn/arx/simulation/output_error.hpp"

namespace wisp::arx {

/// The squared error one step ahead of a block's rows around its least, in scaled units.
struct OneStepLoss {
  const Signals& signals;
  ArxDesign design;
  RowPlan plan;
  Eigen::VectorXd best{};                   ///< the coefficients of least squares, row after row
  std::vector<Eigen::MatrixXd> products{};  ///< of the regressors, per row
  std::vector<double> least{};              ///< per row
  std::vector<std::vector<int>> columns{};  ///< of the design, per row
  std::vector<int> targets{};

  /// Σ over rows of loss / least.
  double value(const Eigen::VectorXd& theta) const;

  void add_to(const Eigen::VectorXd& theta, double weight, GaussNewton& out) const;

  /// Of `weight` times the value, as batch_gradients() of a simulation.
  Eigen::MatrixXd batch_gradients(const Eigen::VectorXd& theta, double weight, int batches) const;
};

/// What the loss is of, beside the block.
struct OneStepOptions {
  const ArxOrders& orders;
  ArxOffset offset = ArxOffset::kMean;
  int first_sample = 0;
  double ridge = 0;  ///< ArxOptions::ridge: a part of the loss
};

/// Precondition: the signals outlive it; the block is of them and the orders.
OneStepLoss one_step_loss(const Signals& signals, const SimulationBlock& block, const OneStepOptions& options);

/// How far to go.
struct RefineOptions {
  double one_step_weight = 0;  ///< of OneStepLoss::value() beside the simulation's cost
  int steps = 60;
  double tolerance = 1e-5;      ///< of the criterion, relative
  std::function<bool()> go_on;  ///< or none
};

struct Refined {
  BlockSimulation simulation;
  double value = 0;            ///< of the criterion
  double one_step_weight = 0;  ///< in it
};

/// Descends from `start`, drawn in where it is unstable; every step is stable.
Refined refine(const SimulationBlock& block, const OneStepLoss& loss, const Eigen::VectorXd& start,
               const RefineOptions& options);

/// Spectral radius that a descent starts within.
inline constexpr double kStartRadius = 0.999;

/// Poles beyond `most` drawn in: a coefficient at lag l with a factor to the power of l.
Eigen::VectorXd drawn_in(const SimulationBlock& block, Eigen::VectorXd theta, double most);

/// Where to descend from, beside `squares`: Steiglitz–McBride's and instrumental variables' estimates, all stable.
std::vector<Eigen::VectorXd> other_starts(const SimulationBlock& block, const Eigen::VectorXd& squares);

/// Beside those: the best simulation of one order less, with a pole and a zero more at the same place, which cancel. A
/// slow mode that least squares has missed is found from there only. None where an order is below 2, or the outputs of
/// the block are several.
std::vector<Eigen::VectorXd> cancelling_starts(const Signals& signals, const SimulationBlock& block,
                                               const OneStepOptions& options, const RefineOptions& how);

/// Weights of the error one step ahead, beside a simulation's that is as small as it can be: from nearly least squares
/// to simulation only.
inline constexpr double kOneStepWeights[] = {30, 10, 3, 1, 0.3, 0.1, 0.03, 0.01, 0};

/// Coefficients that are refined together. Of more, feedback stays as least squares has it.
inline constexpr std::size_t kMaxTerms = 120;

/// The coefficients of inputs and the constant that are best for each weight, with the feedback of `start`: a free
/// simulation is linear in them.
///
/// Precondition: the block is refinable, `start` stable.
std::vector<Refined> drive_path(const SimulationBlock& block, const OneStepLoss& loss, const Eigen::VectorXd& start,
                                std::span<const double> weights);

/// The coefficients that are best for each weight, the largest first.
///
/// Precondition: the block is refinable.
std::vector<Refined> refined_path(const SimulationBlock& block, const OneStepLoss& loss,
                                  const std::vector<Eigen::VectorXd>& starts, std::span<const double> weights,
                                  const RefineOptions& options = {});

}  // namespace wisp::arx
