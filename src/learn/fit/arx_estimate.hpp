#pragma once
// Least squares for a whole design: choice of the factorisation, and the estimate.
//
// The Gram matrix of lagged channels is by far cheaper to form than their triangle (lag_gram.hpp). Its rounding errors
// enter the coefficients multiplied by the squared condition number. A refinement step with residuals from the data
// restores the accuracy of QR for the coefficients, but not for the inverse (standard errors). So the Gram matrix is
// used up to the measured condition number kMaxConditionForGram and Householder QR above it.

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "learn/rows/arx_design.hpp"
#include "learn/rows/arx_rows.hpp"

namespace wisp {

struct DependentColumn {
  int column = 0;       ///< index among the regressors
  std::vector<int> of;  ///< regressors that the column depends on, as indices; empty: the column is zero
};

/// The least-squares solution for output rows that share the regressors X, in scaled units.
struct SharedSolution {
  Eigen::MatrixXd theta;    ///< one column per output row, with prediction signs (−A); 0 for dependent regressors
  Eigen::MatrixXd inverse;  ///< (XᵀX + FᵀF)⁻¹; 0 in rows and columns of dependent regressors
  std::vector<DependentColumn> dependent;
  double condition = 1;         ///< condition number of [X; F] in the data's units, without dependent columns
  double scaled_condition = 1;  ///< condition number of [X; F] with columns of X scaled to norm 1
};

/// The problem to solve: for every target, minimise |target − Xθ|² + |Fθ|².
struct SharedProblem {
  std::vector<int> columns;  ///< X, as columns of the whole regression
  std::vector<int> targets;  ///< targets, as columns of the whole regression
  Eigen::VectorXd unit;      ///< data's unit / scaled unit, per column of X
  Eigen::MatrixXd prior;     ///< F, square; empty: no prior
};

/// Solves the problem from the triangle R of the whole regression; RᵀR is the Gram matrix.
SharedSolution solve_with_triangle(const Eigen::MatrixXd& triangle, const SharedProblem& problem);

/// Coefficients of every group of rows: regressors × rows, in scaled units, with prediction signs (A's are negated).
using GroupThetas = std::vector<Eigen::MatrixXd>;

struct ArxEstimate {
  std::vector<SharedSolution> groups;  ///< one solution per group of the design, in scaled units
  std::vector<double> effective;       ///< effective number of coefficients per output of each group
  Eigen::MatrixXd residual_gram;       ///< ny × ny: Σ r_i r_j
  Eigen::VectorXd target_square;       ///< Σ (y − ȳ)² per output
  std::string method;                  ///< name of the factorisation, and why it was chosen

  Eigen::MatrixXd gram;  ///< products of all columns of the layout; empty unless `joint` was requested

  /// Computes Σ r_i r_j for given coefficients other than the estimate.
  std::function<Eigen::MatrixXd(const GroupThetas&)> residual_gram_at;

  GroupThetas thetas() const;
};

namespace arx {

/// Adjacent columns of a regression that hold one channel's lags, in rising order.
struct KernelBlock {
  int first = 0;
  int size = 0;
};

/// A regression of one target, as products: XᵀX, Xᵀy, yᵀy, and the number of rows.
struct RegressionProducts {
  Eigen::MatrixXd gram;
  Eigen::VectorXd moment;
  double square = 0;
  double rows = 0;
};

/// Returns F such that |y − Xθ|² + |Fθ|² is least at the posterior mean. Columns outside all blocks have no prior.
Eigen::MatrixXd kernel_factor(const RegressionProducts& products, const std::vector<KernelBlock>& blocks);

}  // namespace arx

struct EstimateOptions {
  bool joint = false;                   ///< also compute products of regressors across groups of rows
  ArxKernel kernel = ArxKernel::kNone;  ///< prior; all but kNone need a design with one output per group
  std::vector<int> kernel_outputs{};    ///< outputs with the prior; empty: all
};

/// Estimates from the data. The estimate keeps references to the arguments. Precondition: plan.rows > 0.
ArxEstimate estimate_from_data(const Signals& signals, const RowPlan& plan, const ArxDesign& design,
                               const EstimateOptions& options);

/// Estimates from the triangle of all columns of the design's layout; `scale` per channel as in Signals.
ArxEstimate estimate_from_triangle(const Eigen::MatrixXd& triangle, const std::vector<double>& scale,
                                   const ArxDesign& design, const EstimateOptions& options);

}  // namespace wisp
