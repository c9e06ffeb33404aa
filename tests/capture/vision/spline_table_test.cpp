#include "capture/vision/spline_table.hpp"

#include <gtest/gtest.h>

namespace wisp::spline_table_test {
namespace {

// Knots that lie close together amplify rounding by the ratio of their spans: 0.02 of 0.3 here.
constexpr double kRounding = 1e-11;

const std::vector<double> kKnots = clamped_knots(std::vector<double>{0.1, 0.4, 0.48, 0.5, 0.52, 0.8});

TEST(SplineTable, WeightsAreThoseOfTheBasis) {
  const SplineTable table(kKnots);
  for (int k = 0; k <= 1000; ++k) {
    const double s = k / 1000.0;
    const BasisWeights expected = basis(kKnots, s), found = table.weights(s);
    ASSERT_EQ(found.first, expected.first) << s;
    for (int r = 0; r < 4; ++r) EXPECT_NEAR(found.weight[r], expected.weight[r], kRounding) << s;
  }
}

TEST(SplineTable, DerivativesAreThoseOfTheBasis) {
  const SplineTable table(kKnots);
  for (int k = 0; k <= 1000; ++k) {
    const double s = k / 1000.0;
    const BasisWeights expected = basis_derivative(kKnots, s), found = table.derivatives(s);
    for (int r = 0; r < 4; ++r) EXPECT_NEAR(found.weight[r], expected.weight[r], 1e3 * kRounding) << s;
  }
}

TEST(SplineTable, TheCurveBeginsAndEndsAtItsOutermostPoints) {
  const SplineTable table(uniform_knots(5));
  const std::vector<double> controls{1, 2, 3, 9, 4, 4, 7, 1, 8, 5};
  EXPECT_DOUBLE_EQ(table.at(controls, 0).x, 1);
  EXPECT_NEAR(table.at(controls, 1).x, 8, kRounding);
  EXPECT_NEAR(table.at(controls, 1).y, 5, kRounding);
  EXPECT_EQ(curve_polyline(table, controls, 7).size(), 7u);
}

}  // namespace
}  // namespace wisp::spline_table_test
