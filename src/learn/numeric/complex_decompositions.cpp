// Decompositions with complex results, in a separate source: each half takes as long to compile as the rest together.

#include <Eigen/Dense>

#include "learn/numeric/decompositions.hpp"

namespace wisp {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;

VectorXcd eigenvalues(const MatrixXd& matrix) { return matrix.eigenvalues(); }

MatrixXcd complex_inverse(const MatrixXcd& matrix) { return matrix.inverse(); }

}  // namespace wisp
