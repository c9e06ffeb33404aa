#include "learn/numeric/decompositions.hpp"

#include <Eigen/Dense>

namespace wisp {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

VectorXd singular_values(const MatrixXd& matrix) { return Eigen::BDCSVD<MatrixXd>(matrix).singularValues(); }

VectorXcd eigenvalues(const MatrixXd& matrix) { return matrix.eigenvalues(); }

Eigensystem eigensystem(const MatrixXd& matrix) {
  const Eigen::EigenSolver<MatrixXd> solver(matrix);
  const MatrixXcd right = solver.eigenvectors();
  return {solver.eigenvalues(), right, right.fullPivLu().inverse()};
}

VectorXd symmetric_eigenvalues(const MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

SymmetricEigensystem symmetric_eigensystem(const MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

std::optional<VectorXd> generalized_eigenvalues(const MatrixXd& matrix, const MatrixXd& metric) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(matrix, metric, Eigen::EigenvaluesOnly);
  if (solver.info() != Eigen::Success) return std::nullopt;
  return solver.eigenvalues();
}

MatrixXd pseudo_inverse(const MatrixXd& matrix) { return matrix.completeOrthogonalDecomposition().pseudoInverse(); }

VectorXd shortest_solution(const MatrixXd& matrix, const VectorXd& right) {
  return matrix.completeOrthogonalDecomposition().solve(right);
}

MatrixXcd complex_inverse(const MatrixXcd& matrix) { return matrix.inverse(); }

}  // namespace wisp
