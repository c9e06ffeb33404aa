#include "simulate/candle/flame_outline.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "model/bspline.hpp"

namespace wisp::flame_outline_test {
namespace {

// Light that is 1 inside a teardrop of given height leaning by an angle, with an edge two cells wide.
RigLight teardrop(double height, double lean_degrees) {
  RigLight light{96, 128, 0.5, 20, 10, {}, {}};
  const double lean = lean_degrees * 3.14159265358979323846 / 180;
  for (int j = 0; j < light.rows; ++j)
    for (int i = 0; i < light.columns; ++i) {
      const double x = (i + 0.5) * light.cell_mm - light.wick_x_mm;
      const double y = (j + 0.5) * light.cell_mm - light.wick_y_mm;
      const double along = (x * std::sin(lean) + y * std::cos(lean)) / height;
      const double across = x * std::cos(lean) - y * std::sin(lean);
      const double inside = along > 0 && along < 1 ? 4 * std::sqrt(along) * (1 - along) * 2 - std::abs(across) : -1.0;
      light.soot.push_back(static_cast<float>(1 / (1 + std::exp(-6 * inside))));
    }
  light.blue.assign(light.soot.size(), 0.0F);
  return light;
}

TEST(FlameOutline, FindsTipHeightAndLeanOfATeardrop) {
  const FlameOutline outline = flame_outline(teardrop(30, 20));
  ASSERT_TRUE(outline.found);
  EXPECT_NEAR(outline.lean, 20, 2);
  EXPECT_NEAR(outline.tip.x, 30 * std::sin(20 * 3.14159 / 180), 1.5);
  EXPECT_NEAR(outline.tip.y, 30 * std::cos(20 * 3.14159 / 180), 1.5);
}

TEST(FlameOutline, RunsFromTheBasesLeftOverTheTipToTheBasesRight) {
  const FlameOutline outline = flame_outline(teardrop(30, 0));
  EXPECT_LT(outline.contour.front().x, outline.contour.back().x);
  EXPECT_NEAR(outline.contour.front().y, outline.contour.back().y, 1e-9);
  EXPECT_NEAR(outline.contour[outline.contour.size() / 2].y, outline.tip.y, 0.5);
  EXPECT_LT(outline.control_points[1].x, outline.control_points[6].x);
}

PointMm point_of_spline(const std::vector<PointMm>& control, double s) {
  const BasisWeights at = basis(uniform_knots(static_cast<int>(control.size())), s);
  PointMm sum;
  for (int k = 0; k < 4; ++k) {
    sum.x += at.weight[k] * control[at.first + k].x;
    sum.y += at.weight[k] * control[at.first + k].y;
  }
  return sum;
}

TEST(FlameOutline, SplineFollowsTheContourWithinAThirdOfACell) {
  const FlameOutline outline = flame_outline(teardrop(30, 25));
  double sum = 0;
  for (const PointMm& p : outline.contour) {
    double nearest = 1e9;
    for (int k = 0; k <= 500; ++k) {
      const PointMm s = point_of_spline(outline.control_points, k / 500.0);
      nearest = std::min(nearest, std::hypot(s.x - p.x, s.y - p.y));
    }
    sum += nearest;
  }
  EXPECT_LT(sum / static_cast<double>(outline.contour.size()), 0.5 / 3);
}

TEST(FlameOutline, OfDarknessIsNotFound) {
  RigLight light = teardrop(30, 0);
  for (float& value : light.soot) value *= 0.2F;
  const FlameOutline outline = flame_outline(light);
  EXPECT_FALSE(outline.found);
  EXPECT_TRUE(outline.control_points.empty());
  EXPECT_GT(outline.brightness, 0);
}

TEST(FlameOutline, OfAFlameThatLeavesTheGridIsClosedAlongItsRim) {
  RigLight light = teardrop(30, 0);
  light.rows = 60;  // cut at 20 mm above the rim
  light.soot.resize(static_cast<std::size_t>(light.columns) * light.rows);
  light.blue.resize(light.soot.size());
  const FlameOutline outline = flame_outline(light);
  ASSERT_TRUE(outline.found);
  EXPECT_NEAR(outline.tip.y, 20, 1);
}

}  // namespace
}  // namespace wisp::flame_outline_test
