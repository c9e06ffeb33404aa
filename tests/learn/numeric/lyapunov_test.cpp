// The search for a common Lyapunov function goes beyond its first guess, and finds none where there can't be one.

#include "learn/numeric/lyapunov.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <vector>

namespace wisp::lyapunov_test {
namespace {

using Eigen::MatrixXd;
using Numbers = std::vector<double>;

MatrixXd matrix(const Numbers& numbers, int n) {
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(numbers.data(), n, n);
}

Numbers row_major(const MatrixXd& m) {
  Numbers out;
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    for (Eigen::Index j = 0; j < m.cols(); ++j) out.push_back(0.5 * (m(i, j) + m(j, i)));
  }
  return out;
}

// The mode's own function of unit trace: Σ (Aᵀ)ˡ Aˡ, by as many terms as matter.
MatrixXd own_function(const MatrixXd& a) {
  MatrixXd power = MatrixXd::Identity(a.rows(), a.cols()), sum = MatrixXd::Zero(a.rows(), a.cols());
  for (int l = 0; l < 3000; ++l) {
    sum += power.transpose() * power;
    power = a * power;
  }
  return sum / sum.trace();
}

struct Pair {
  int states;
  Numbers first, second;
  Numbers common;  // proven below to be a function of both
};

// Contractions in an oblique metric, which is their common function: made by chance, rounded, and kept where nothing
// that is made of their own functions will do.
const std::vector<Pair> kHardPairs{
    {2, {1.31, -0.14, 1.82, 0.51}, {-1.28, 0.49, -2.92, 1.42}, {13, -3, -3, 1}},
    {2, {1.2, -0.61, 4.78, -1.89}, {1.29, -0.19, 5.38, -1.35}, {17, -5, -5, 2}},
    {3,
     {0.46, -1.32, -1.95, -0.02, 1.22, 1.61, -0.25, -1.26, -1.03},
     {-0.41, -2.07, -1.94, -0.17, 0.75, 0.4, -0.11, -0.62, 0.11},
     {2, 2, 1, 2, 11, 10, 1, 10, 14}},
    {3,
     {1.1, -0.26, -0.03, 2.48, -0.64, -0.51, 2.86, -1.22, 0.11},
     {-1.01, 0.41, 0.04, -2.27, 0.51, 0.61, 2.22, -0.8, 0.9},
     {1003, -350, 51, -350, 174, -41, 51, -41, 49}},
};

StateBlock block_of(const Pair& pair) { return {{0}, pair.states, {pair.first, pair.second}}; }

TEST(CommonLyapunov, OfTheHardPairsIsNoMixtureOfTheirOwn) {
  for (const Pair& pair : kHardPairs) {
    const StateBlock block = block_of(pair);
    EXPECT_TRUE(is_common_lyapunov(block, pair.common));
    const MatrixXd first = own_function(matrix(pair.first, pair.states));
    const MatrixXd second = own_function(matrix(pair.second, pair.states));
    for (int share = 0; share <= 20; ++share) {
      const MatrixXd mixed = share / 20.0 * first + (1 - share / 20.0) * second;
      EXPECT_FALSE(is_common_lyapunov(block, row_major(mixed))) << share;
    }
  }
}

TEST(CommonLyapunov, OfTheHardPairsIsFoundBySearch) {
  for (const Pair& pair : kHardPairs) {
    const auto found = find_common_lyapunov(block_of(pair));
    ASSERT_TRUE(found);
    EXPECT_TRUE(is_common_lyapunov(block_of(pair), *found));
  }
}

// Each has its poles inside the circle, their product one outside: played by turns they diverge.
TEST(CommonLyapunov, OfAPairWhoseProductDivergesIsNotFound) {
  const Numbers up{0.6, 1.5, 0, 0.6}, down{0.6, 0, 1.5, 0.6};
  const MatrixXd product = matrix(up, 2) * matrix(down, 2);
  EXPECT_LT(matrix(up, 2).eigenvalues().cwiseAbs().maxCoeff(), 0.61);
  EXPECT_GT(product.eigenvalues().cwiseAbs().maxCoeff(), 1);
  EXPECT_FALSE(find_common_lyapunov(StateBlock{{0}, 2, {up, down}}));
}

// The same pair, coupled less. Up to the coupling at which the product's radius is 1 the norm is a function of both
// (its square has the same equation), and beyond it there is none: the search ends within a part in 6000 of the truth.
TEST(CommonLyapunov, IsFoundUpToWhereThePairBeginsToDiverge) {
  // ρ(up · down) = 1 where 2·0.36 + k² + k√(k² + 4·0.36) = 2, so k = 0.64.
  const auto pair = [](double k) { return StateBlock{{0}, 2, {{0.6, k, 0, 0.6}, {0.6, 0, k, 0.6}}}; };
  EXPECT_TRUE(find_common_lyapunov(pair(0.6399)));
  EXPECT_FALSE(find_common_lyapunov(pair(0.6401)));
}

}  // namespace
}  // namespace wisp::lyapunov_test
