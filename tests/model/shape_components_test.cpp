#include "wisp/model/shape_components.hpp"

#include <gtest/gtest.h>

namespace wisp::shape_components_test {
namespace {

TEST(ShapeComponents, CoordinatesPairTheFlanksAndComeBack) {
  const std::vector<double> control{-0.2, 0.01, -0.1, 0.5, 0.05, 1, 0.15, 0.6, 0.2, -0.01};
  const std::vector<double> at = shape_coordinates(control);
  EXPECT_DOUBLE_EQ(at[2], 0.125);  // half the width of the second pair
  EXPECT_DOUBLE_EQ(at[3], 0.55);   // its height
  EXPECT_DOUBLE_EQ(at[4], 1);      // the middle point's height
  EXPECT_DOUBLE_EQ(at[7], 0.025);  // the second pair's lean
  EXPECT_DOUBLE_EQ(at[9], 0.05);   // the middle point's
  const std::vector<double> back = control_points(at);
  for (std::size_t k = 0; k < control.size(); ++k) EXPECT_DOUBLE_EQ(back[k], control[k]);
}

TEST(ShapeComponents, CoordinatesAreClampedToTheirRanges) {
  const ShapeComponents shape{
      1, 1, {0.1, 0, 0, 0}, {0.1, 0, 0.2, 0}, {{0.02, 0.3}, {0, 0}, {-0.1, 0.1}, {0, 0}}, {{-3, 3}, {-3, 3}}};
  ASSERT_TRUE(check(shape, 2));
  const auto within = control_points(shape, std::vector<double>{1, 0.25});
  const auto beyond = control_points(shape, std::vector<double>{-2, 9});
  const double wanted_within[] = {-0.15, 0, 0.25, 0}, wanted_beyond[] = {0.08, 0, 0.12, 0};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_DOUBLE_EQ(within[k], wanted_within[k]);
    EXPECT_DOUBLE_EQ(beyond[k], wanted_beyond[k]);
  }
}

}  // namespace
}  // namespace wisp::shape_components_test
