// Whether a curve runs over itself.

#include "capture/vision/spline_table.hpp"

#include <gtest/gtest.h>

namespace wisp::crossing_test {
namespace {

bool crosses(const std::vector<CurvePoint>& polyline) { return crosses_itself(polyline); }

TEST(Crossing, AnArchDoesNotCrossItself) { EXPECT_FALSE(crosses({{0, 0}, {1, 3}, {2, 4}, {3, 3}, {4, 0}})); }

TEST(Crossing, ALoopAtTheTipDoes) { EXPECT_TRUE(crosses({{0, 0}, {3, 4}, {2, 5}, {1, 4}, {4, 0}})); }

TEST(Crossing, EndsThatMeetDoNot) { EXPECT_FALSE(crosses({{0, 0}, {1, 3}, {2, 0}, {0, 0}})); }

}  // namespace
}  // namespace wisp::crossing_test
