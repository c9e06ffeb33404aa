// What has complex results, apart from the rest: either half takes as long to compile as all else of the folder.

#include <Eigen/Dense>

#include "learn/numeric/decompositions.hpp"

namespace wisp {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;

VectorXcd eigenvalues(const MatrixXd& matrix) { return matrix.eigenvalues(); }

Eigensystem eigensystem(const MatrixXd& matrix) {
  const Eigen::EigenSolver<MatrixXd> solver(matrix);
  const MatrixXcd right = solver.eigenvectors();
  return {solver.eigenvalues(), right, right.fullPivLu().inverse()};
}

MatrixXcd complex_inverse(const MatrixXcd& matrix) { return matrix.inverse(); }

}  // namespace wisp
