#pragma once
// Wrappers that compile Eigen's slow-to-compile decompositions once: each takes 5 to 20 s in a source that uses it.

#include <Eigen/Core>

namespace wisp {

/// Singular values, largest first; their absolute error is the rounding error of the largest. Runs eight times longer
/// than bidiagonalisation, which takes half a minute to compile.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& matrix);

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix);

/// Eigenvalues of a symmetric matrix, smallest first.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);

struct SymmetricEigensystem {
  Eigen::VectorXd values;   ///< eigenvalues, smallest first
  Eigen::MatrixXd vectors;  ///< one eigenvector per column
};

SymmetricEigensystem symmetric_eigensystem(const Eigen::MatrixXd& matrix);

struct RankedSolution {
  Eigen::VectorXd x;
  Eigen::Index rank;  ///< rank of the matrix
};

/// Minimum-norm solution of the least-squares problem |`matrix` x − `right`|, with the numerical rank.
RankedSolution ranked_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

/// Solves with a positive or negative semidefinite matrix, of which only the lower triangle is read.
Eigen::VectorXd symmetric_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);
Eigen::MatrixXd symmetric_solutions(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

Eigen::MatrixXcd complex_inverse(const Eigen::MatrixXcd& matrix);

}  // namespace wisp
