#pragma once
// Least squares for a whole design: which factorisation, and what comes out of it.
//
// The Gram matrix of lagged channels costs least by far (lag_gram.hpp). Its rounding errors enter the coefficients
// multiplied by the condition squared; one step of refinement with residuals from the data takes that back to what QR
// has, while the inverse (standard errors) keeps it. So the Gram matrix is used up to kMaxConditionForGram and
// Householder QR beyond, whichever the measured condition says.

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "learn/arx/rows/arx_design.hpp"
#include "learn/arx/rows/arx_rows.hpp"

namespace wisp {

/// A regressor that depends on those before it.
struct DependentColumn {
  int column = 0;       ///< position among the rows' regressors
  std::vector<int> of;  ///< positions of those that it depends on; empty: the column is zero
};

/// The least-squares solution of rows with the same regressors X, in scaled units.
struct SharedSolution {
  Eigen::MatrixXd theta;    ///< one column an output row, without A's sign; 0 for dependent regressors
  Eigen::MatrixXd inverse;  ///< (XᵀX + FᵀF)⁻¹; 0 in rows and columns of dependent regressors
  std::vector<DependentColumn> dependent;
  double condition = 1;         ///< of X with its columns in the data's units, dependent ones left out
  double scaled_condition = 1;  ///< of X with columns of norm 1
};

/// What to solve: for every target, minimise |target − Xθ|² + |Fθ|².
struct SharedProblem {
  std::vector<int> columns;  ///< X, as columns of the whole regression
  std::vector<int> targets;  ///< columns of the whole regression
  Eigen::VectorXd unit;      ///< data's unit / scaled unit, per column of X
  Eigen::MatrixXd prior;     ///< F, square; empty: none
};

/// Solves with RᵀR = Gram, R the triangle of the whole regression.
SharedSolution solve_with_triangle(const Eigen::MatrixXd& triangle, const SharedProblem& problem);

/// Solves with the Gram matrix of the whole regression, or gives up where the scaled condition is above
/// `max_condition` or the matrix is not positive definite.
std::optional<SharedSolution> solve_with_gram(const Eigen::MatrixXd& gram, const SharedProblem& problem,
                                              double max_condition);

/// Nine digits in standard errors: condition² · 2.2e-16 = 1e-9.
inline constexpr double kMaxConditionForGram = 2e3;

/// Coefficients of every group of rows: regressors × rows, in scaled units, without A's sign.
using GroupThetas = std::vector<Eigen::MatrixXd>;

struct ArxEstimate {
  std::vector<SharedSolution> groups;  ///< as the design's, in scaled units
  std::vector<double> effective;       ///< per group: number of coefficients, or what a kernel leaves of it
  Eigen::MatrixXd residual_gram;       ///< ny × ny: Σ r_i r_j
  Eigen::VectorXd target_square;       ///< Σ (y − ȳ)² per output
  std::string method;                  ///< which factorisation and why

  Eigen::MatrixXd gram;  ///< of all columns of the layout; empty unless `joint` was requested

  /// Σ r_i r_j for other coefficients than the estimate's.
  std::function<Eigen::MatrixXd(const GroupThetas&)> residual_gram_at;

  GroupThetas thetas() const;
};

/// What to compute.
struct EstimateOptions {
  bool joint = false;                   ///< also the products that tie rows of different groups together
  ArxKernel kernel = ArxKernel::kNone;  ///< with one, every group has one output
  std::vector<int> kernel_outputs{};    ///< outputs that have the kernel; empty: all
};

/// From the data. The estimate keeps references to its arguments.
///
/// Precondition: plan.rows > 0.
ArxEstimate estimate_from_data(const Signals& signals, const RowPlan& plan, const ArxDesign& design,
                               const EstimateOptions& options);

/// From the triangle of all columns of the design's layout; `scale` per channel as in Signals.
ArxEstimate estimate_from_triangle(const Eigen::MatrixXd& triangle, const std::vector<double>& scale,
                                   const ArxDesign& design, const EstimateOptions& options);

}  // namespace wisp
