#include "learn/numeric/decompositions.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <limits>

namespace wisp::decompositions_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// An orthogonal matrix: a reflection.
MatrixXd reflection(Index size, double tilt) {
  const VectorXd normal = VectorXd::LinSpaced(size, 1, tilt).normalized();
  return MatrixXd::Identity(size, size) - 2 * normal * normal.transpose();
}

MatrixXd with_singular_values(const VectorXd& values, Index rows) {
  return reflection(rows, -2).leftCols(values.size()) * values.asDiagonal() * reflection(values.size(), 3);
}

// An eigenvalue of a symmetric matrix is known to within rounding of the largest, times a small multiple of its size.
TEST(Decompositions, SingularValuesAreThoseThatAMatrixWasMadeOf) {
  VectorXd values(6);
  values << 3e4, 70, 5, 5, 2e-3, 1e-6;
  const double rounding = 20 * std::numeric_limits<double>::epsilon() * values[0];
  for (const Index rows : {6, 9}) {
    const MatrixXd made = with_singular_values(values, rows);
    EXPECT_LT((singular_values(made) - values).cwiseAbs().maxCoeff(), rounding) << rows;
    EXPECT_LT((singular_values(made.transpose()) - values).cwiseAbs().maxCoeff(), rounding) << rows;
  }
}

TEST(Decompositions, SingularValuesOfAnIncompleteRankEndInZeros) {
  VectorXd values = VectorXd::Zero(5);
  values.head(3) << 2, 1, 0.5;
  const VectorXd found = singular_values(with_singular_values(values, 5));
  EXPECT_LT(found.tail(2).maxCoeff(), 1e-14);
  EXPECT_GE(found.tail(2).minCoeff(), 0);
}

TEST(Decompositions, ARankedSolutionIsTheShortestAndCountsColumns) {
  VectorXd values = VectorXd::Zero(5);
  values.head(3) << 2, 1, 0.5;
  const MatrixXd matrix = with_singular_values(values, 5);
  const VectorXd asked = VectorXd::LinSpaced(5, 0, 4);
  const RankedSolution found = ranked_solution(matrix, matrix * asked);
  EXPECT_EQ(found.rank, 3);
  EXPECT_LT((matrix * (found.x - asked)).norm(), 1e-13);
  // Nothing of it lies where the matrix sees nothing: in the last two columns of the right reflection.
  EXPECT_LT((reflection(5, 3).bottomRows(2) * found.x).norm(), 1e-13);
}

}  // namespace
}  // namespace wisp::decompositions_test
