#include "learn/numeric/decompositions.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace wisp {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Source: G. H. Golub and C. F. Van Loan, Matrix Computations, section 8.6: singular values are the positive
// eigenvalues of [0 A; Aᵀ 0].
VectorXd singular_values(const MatrixXd& matrix) {
  const Eigen::Index rows = matrix.rows(), all = rows + matrix.cols();
  MatrixXd both = MatrixXd::Zero(all, all);
  both.topRightCorner(rows, matrix.cols()) = matrix;
  both.bottomLeftCorner(matrix.cols(), rows) = matrix.transpose();
  return symmetric_eigenvalues(both).tail(std::min(rows, matrix.cols())).reverse().cwiseMax(0);
}

VectorXd symmetric_eigenvalues(const MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

SymmetricEigensystem symmetric_eigensystem(const MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

RankedSolution ranked_solution(const MatrixXd& matrix, const VectorXd& right) {
  const Eigen::CompleteOrthogonalDecomposition<MatrixXd> solver(matrix);
  return {solver.solve(right), solver.rank()};
}

VectorXd symmetric_solution(const MatrixXd& matrix, const VectorXd& right) { return matrix.ldlt().solve(right); }

MatrixXd symmetric_solutions(const MatrixXd& matrix, const MatrixXd& right) { return matrix.ldlt().solve(right); }

}  // namespace wisp
