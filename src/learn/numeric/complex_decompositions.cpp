// Decompositions with complex results. A separate source, since they take as long to compile as decompositions.cpp.

#include <Eigen/Dense>

#include "learn/numeric/decompositions.hpp"

namespace wisp {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;

VectorXcd eigenvalues(const MatrixXd& matrix) { return matrix.eigenvalues(); }

MatrixXcd complex_inverse(const MatrixXcd& matrix) { return matrix.inverse(); }

}  // namespace wisp
