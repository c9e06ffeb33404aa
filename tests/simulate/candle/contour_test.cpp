#include "simulate/candle/flame_outline.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace wisp::flow::contour_test {
namespace {

std::vector<float> hill(int columns, int rows, double x, double y, double radius) {
  std::vector<float> values;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) values.push_back(static_cast<float>(radius - std::hypot(i - x, j - y)));
  return values;
}

TEST(Contour, OfAConeIsACircleThatRunsClockwise) {
  const auto contours = closed_contours(hill(40, 40, 19.3, 20.6, 10), 40, 40, 0);
  ASSERT_EQ(contours.size(), 1U);
  EXPECT_NEAR(clockwise_area(contours[0]), 3.14159 * 100, 1);
  for (const PointMm& p : contours[0]) EXPECT_NEAR(std::hypot(p.x - 19.3, p.y - 20.6), 10, 0.05);
}

TEST(Contour, OfAHoleRunsTheOtherWay) {
  std::vector<float> values = hill(40, 40, 20, 20, 10);
  for (float& value : values) value = -value;
  const auto contours = closed_contours(values, 40, 40, 0);
  ASSERT_EQ(contours.size(), 1U);
  EXPECT_LT(clockwise_area(contours[0]), -300);
}

TEST(Contour, ThatEndsAtTheRimIsLeftOut) { EXPECT_TRUE(closed_contours(hill(40, 40, 0, 20, 10), 40, 40, 0).empty()); }

TEST(Contour, OfASaddleFollowsTheSquaresMean) {
  // Two corners of a square inside: apart when the mean is below the level, joined when it is above.
  std::vector<float> apart = {0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0};
  EXPECT_EQ(closed_contours(apart, 4, 4, 0.6F).size(), 2U);
  EXPECT_EQ(closed_contours(apart, 4, 4, 0.4F).size(), 1U);
}

}  // namespace
}  // namespace wisp::flow::contour_test
