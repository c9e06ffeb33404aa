#pragma once
// Those of Eigen's decompositions that take long to compile, compiled once: each costs a source that uses it five to
// twenty seconds.

#include <Eigen/Core>

namespace wisp {

/// The largest first, each within rounding of the largest. Takes eight times what bidiagonalising would, which itself
/// takes half a minute to compile.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& matrix);

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix);

/// Of a symmetric matrix: the smallest first.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);

struct SymmetricEigensystem {
  Eigen::VectorXd values;   ///< the smallest first
  Eigen::MatrixXd vectors;  ///< a column each
};

SymmetricEigensystem symmetric_eigensystem(const Eigen::MatrixXd& matrix);

/// Of all x with the least |`matrix` x − `right`| the shortest.
Eigen::VectorXd shortest_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

struct RankedSolution {
  Eigen::VectorXd x;
  Eigen::Index rank;  ///< of the matrix
};

/// The same, and how many columns count.
RankedSolution ranked_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

/// Of a symmetric matrix that is not indefinite, of which only the lower triangle is read.
Eigen::VectorXd symmetric_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
Eigen::MatrixXd symmetric_solutions(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

Eigen::MatrixXcd complex_inverse(const Eigen::MatrixXcd& matrix);

}  // namespace wisp
