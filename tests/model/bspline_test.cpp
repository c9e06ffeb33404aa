#include "model/bspline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wisp::bspline_test {
namespace {

double sum(const BasisWeights& weights) {
  double total = 0;
  for (double weight : weights.weight) total += weight;
  return total;
}

TEST(BSpline, FourUniformPointsAreABezierCurve) {
  const auto knots = uniform_knots(4);
  for (double s : {0.0, 0.25, 0.5, 0.9, 1.0}) {
    const auto found = basis(knots, s);
    const double r = 1 - s;
    EXPECT_EQ(found.first, 0);
    EXPECT_NEAR(found.weight[0], r * r * r, 1e-15);
    EXPECT_NEAR(found.weight[1], 3 * s * r * r, 1e-15);
    EXPECT_NEAR(found.weight[2], 3 * s * s * r, 1e-15);
    EXPECT_NEAR(found.weight[3], s * s * s, 1e-15);
  }
}

TEST(BSpline, WeightsSumToOneAreNotNegativeAndReachBothEnds) {
  const auto knots = clamped_knots(std::vector<double>{0.1, 0.4, 0.4, 0.45, 0.9});
  ASSERT_TRUE(valid_knots(knots));
  for (int k = 0; k <= 1000; ++k) {
    const auto found = basis(knots, k / 1000.0);
    EXPECT_NEAR(sum(found), 1, 1e-14);
    for (double weight : found.weight) EXPECT_GE(weight, 0);
    EXPECT_GE(found.first, 0);
    EXPECT_LE(found.first + 4, 9);
  }
  EXPECT_EQ(basis(knots, 0).weight[0], 1);
  EXPECT_EQ(basis(knots, 1).weight[3], 1);
}

TEST(BSpline, TheDerivativeAgreesWithDifferences) {
  const auto knots = clamped_knots(std::vector<double>{0.2, 0.5, 0.6});
  const double h = 1e-6;
  for (double s : {0.1, 0.3, 0.55, 0.8}) {
    const auto low = basis(knots, s - h), high = basis(knots, s + h);
    const auto slope = basis_derivative(knots, s);
    EXPECT_NEAR(sum(slope), 0, 1e-12);
    // Central differences of a cubic with |third derivative| < 1e4: h² 1e4 / 6 and rounding 1e-16/h.
    for (int r = 0; r < 4; ++r) EXPECT_NEAR(slope.weight[r], (high.weight[r] - low.weight[r]) / (2 * h), 1e-8);
  }
}

TEST(BSpline, KnotVectorsThatAreNotOnesAreRefused) {
  EXPECT_TRUE(valid_knots(uniform_knots(8)));
  EXPECT_FALSE(valid_knots(std::vector<double>{0, 0, 0, 1, 1, 1}));
  EXPECT_FALSE(valid_knots(clamped_knots(std::vector<double>{0.5, 0.4})));
  EXPECT_FALSE(valid_knots(clamped_knots(std::vector<double>{0.5, 0.5, 0.5, 0.5})));
  EXPECT_FALSE(valid_knots(clamped_knots(std::vector<double>{1.0})));
  EXPECT_FALSE(valid_knots(clamped_knots(std::vector<double>{std::numeric_limits<double>::quiet_NaN()})));
  EXPECT_FALSE(valid_knots(std::vector<double>{0, 0, 0, 0, 2, 2, 2, 2}));
}

}  // namespace
}  // namespace wisp::bspline_test
