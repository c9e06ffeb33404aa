#pragma once
// Coefficients of output rows that share their regressors, from products or from a triangle.
//
// Source: A. Björck, Numerical Methods for Least Squares Problems, sections 2.2 (Cholesky of the normal equations), 2.4
// (Householder QR), 2.7 (rank), 6.6.5 (corrected normal equations).

#include <Eigen/Core>
#include <optional>
#include <vector>

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

}  // namespace wisp
