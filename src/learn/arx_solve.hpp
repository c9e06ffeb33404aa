#pragma once
// One output row's coefficients from the triangle of the whole regression.

#include <Eigen/Core>
#include <vector>

namespace wisp {

/// A regressor that depends on those before it: column = Σ weight · column[of].
struct DependentColumn {
  int column = 0;       ///< position among the row's regressors
  std::vector<int> of;  ///< positions of those that it depends on; empty: the column is zero
};

/// The least-squares solution of one output row, in scaled units.
struct RowSolution {
  Eigen::VectorXd theta;    ///< without A's sign; 0 for dependent columns
  Eigen::MatrixXd inverse;  ///< (XᵀX)⁻¹ over all regressors; rows and columns of dependent ones are 0
  std::vector<DependentColumn> dependent;
  double condition = 1;         ///< of X with its columns weighted by `unit`
  double scaled_condition = 1;  ///< of X with columns of norm 1
};

/// What to solve: minimise |R(:, target) − R(:, regressors) θ|² + ridge Σ |R(:, regressor)|² θ².
struct RowProblem {
  const Eigen::MatrixXd& triangle;
  std::vector<int> regressors;  ///< columns of the triangle
  int target = 0;               ///< column of the triangle
  Eigen::VectorXd unit;         ///< data's unit / scaled unit, per regressor
  double ridge = 0;
};

RowSolution solve_row(const RowProblem& problem);

}  // namespace wisp
