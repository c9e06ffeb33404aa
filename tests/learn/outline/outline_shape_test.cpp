#include "learn/outline/outline_shape.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "model/bspline.hpp"

namespace wisp::outline_shape_test {
namespace {

using Polygon = std::vector<OutlinePoint>;

Polygon square(double left, double bottom, double side) {
  return {{left, bottom}, {left, bottom + side}, {left + side, bottom + side}, {left + side, bottom}};
}

Polygon circle(double x, double y, double radius) {
  Polygon out;
  for (int k = 0; k < 2000; ++k) {
    const double angle = 2 * std::numbers::pi * k / 2000;
    out.push_back({x + radius * std::cos(angle), y + radius * std::sin(angle)});
  }
  return out;
}

TEST(OutlineShape, CurveRunsFromTheFirstControlPointToTheLast) {
  const OutlineCurve curve(uniform_knots(6), 50);
  const auto points = curve.polyline(std::vector<double>{-1, 0, -2, 1, -1, 3, 1, 3, 2, 1, 1, 0});
  ASSERT_EQ(points.size(), 50u);
  EXPECT_EQ(points.front(), (OutlinePoint{-1, 0}));
  EXPECT_EQ(points.back(), (OutlinePoint{1, 0}));
  // By symmetry.
  EXPECT_NEAR(points[24][0] + points[25][0], 0, 1e-12);
}

TEST(OutlineShape, PointsAtEqualLengthsForgetTheParameter) {
  // The same corner, walked in even and in uneven steps.
  const Polygon even = {{0, 0}, {0, 1}, {0, 2}, {1, 2}, {2, 2}};
  const Polygon uneven = {{0, 0}, {0, 0.1}, {0, 2}, {0, 2}, {0.3, 2}, {2, 2}};
  const auto a = at_equal_lengths(even, 9);
  const auto b = at_equal_lengths(uneven, 9);
  ASSERT_EQ(a.size(), 9u);
  EXPECT_EQ(a.front(), (OutlinePoint{0, 0}));
  EXPECT_EQ(a.back(), (OutlinePoint{2, 2}));
  EXPECT_NEAR(a[2][1], 1, 1e-12);
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_NEAR(a[k][0], b[k][0], 1e-12) << k;
    EXPECT_NEAR(a[k][1], b[k][1], 1e-12) << k;
  }
}

TEST(OutlineShape, TheTipIsFarthestFromTheBaseWhereverItPoints) {
  // A spike to the right, its base at the left end.
  Polygon spike;
  for (int k = 0; k <= 100; ++k) spike.push_back({4.0 - std::abs(k - 50) * 0.08, 1 + (k - 50) * -0.002});
  const OutlinePoint tip = tip_of(spike);
  EXPECT_NEAR(tip[0], 4, 0.1);
  EXPECT_NEAR(tip[1], 1, 0.01);
  EXPECT_NEAR(height_of(spike), 4, 0.1);
}

TEST(OutlineShape, AreaOfASquareAndACircle) {
  EXPECT_NEAR(enclosed_area(square(1, 2, 3)), 9, 1e-9);
  EXPECT_NEAR(enclosed_area(circle(0, 0, 2)) / (4 * std::numbers::pi), 1, 1e-3);
}

TEST(OutlineShape, OverlapOfShiftedSquaresIsAThird) {
  EXPECT_NEAR(overlap_of(square(0, 0, 2), square(1, 0, 2)), 1.0 / 3, 1e-12);
  EXPECT_NEAR(overlap_of(square(0, 0, 2), square(0, 1, 2)), 1.0 / 3, 1e-3);
}

TEST(OutlineShape, OverlapOfCirclesAgreesWithTheLensFormula) {
  const double d = 1;
  const double lens = 2 * std::acos(d / 2) - d / 2 * std::sqrt(4 - d * d);  // radius 1
  const double expected = lens / (2 * std::numbers::pi - lens);
  EXPECT_NEAR(overlap_of(circle(0, 0, 1), circle(0.6, 0.8, 1)), expected, 1e-4);
}

TEST(OutlineShape, OverlapIsOneWithItselfAndZeroFarAway) {
  EXPECT_DOUBLE_EQ(overlap_of(circle(0, 0, 1), circle(0, 0, 1)), 1);
  EXPECT_DOUBLE_EQ(overlap_of(circle(0, 0, 1), circle(5, 0, 1)), 0);
}

TEST(OutlineShape, WhereAnOutlineFoldsOverItselfItIsEmpty) {
  // A bow tie: two triangles of base 2 and height 1.
  const Polygon bow{{0, 0}, {2, 2}, {2, 0}, {0, 2}};
  EXPECT_NEAR(overlap_of(bow, square(0, 0, 2)), 0.5, 1e-2);
}

TEST(OutlineShape, ABowTieCrossesItselfAndAFlameDoesNot) {
  EXPECT_TRUE(crosses_itself(Polygon{{0, 0}, {2, 2}, {2, 0}, {0, 2}}));
  EXPECT_FALSE(crosses_itself(circle(0, 0, 1)));
  EXPECT_FALSE(crosses_itself(square(0, 0, 1)));
  // Only the closing line of the base crosses.
  EXPECT_TRUE(crosses_itself(Polygon{{0, 0}, {-1, 2}, {1, 2}, {1, 1}, {0.5, -1}, {2, 1}}));
}

TEST(OutlineShape, NothingOverlapsNothing) {
  const Polygon line{{0, 0}, {1, 0}};
  EXPECT_EQ(overlap_of(line, line), 0);
}

}  // namespace
}  // namespace wisp::outline_shape_test
