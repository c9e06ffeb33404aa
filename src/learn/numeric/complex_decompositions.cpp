// What has complex results, apart from the rest: either half takes as long to compile as all else of the folder.

#include <Eigen/Dense>

#include "learn/numeric/decompositions.hpp"

namespace wisp {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;

VectorXcd eigenvalues(const MatrixXd& matrix) { return matrix.eigenvalues(); }

MatrixXcd complex_inverse(const MatrixXcd& matrix) { return matrix.inverse(); }

}  // namespace wisp
