#include "capture/vision/edge_cloud.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "capture/support/seen_flame.hpp"

namespace wisp::edge_cloud_test {
namespace {

using support::cloud_of;
using support::Flame;
using support::flame_picture;
using support::Plane;

constexpr int kLevel = 118;  // half way between the flame's 230 and the ground's 8

TEST(EdgeCloud, RunsFromTheBasesLeftOverTheTipToItsRight) {
  const EdgeCloud cloud = cloud_of(flame_picture(Flame{}), kLevel);
  ASSERT_FALSE(cloud.points.empty());
  EXPECT_LT(cloud.points.front().x, 80);
  EXPECT_GT(cloud.points.back().x, 80);
  const auto tip = std::min_element(cloud.points.begin(), cloud.points.end(),
                                    [](const EdgePoint& a, const EdgePoint& b) { return a.y < b.y; });
  EXPECT_NEAR(cloud.s[static_cast<std::size_t>(tip - cloud.points.begin())], 0.5, 0.05);
  EXPECT_TRUE(std::is_sorted(cloud.s.begin(), cloud.s.end()));
  EXPECT_DOUBLE_EQ(cloud.s.front(), 0);
  EXPECT_NEAR(cloud.s.back(), 1, 1e-12);
}

TEST(EdgeCloud, FollowsTheSidesToATenthOfAPixel) {
  // Rounding to grey levels gives 0.01 px; the depth used to paint is exact only to the bend of the sides.
  const Flame flame;
  const EdgeCloud cloud = cloud_of(flame_picture(flame), kLevel);
  for (const EdgePoint& p : cloud.points) {
    if (p.y > flame.base_y - 10 || p.y < flame.base_y - 0.85 * flame.height) continue;
    EXPECT_NEAR(flame.depth(p.x, p.y), 0, 0.1) << p.x << ' ' << p.y;
  }
}

TEST(EdgeCloud, EndsAtTheCornersOfTheBase) {
  const Flame flame;
  const EdgeCloud cloud = cloud_of(flame_picture(flame), kLevel);
  EXPECT_NEAR(cloud.points.front().x, flame.base_x - flame.reach(flame.base_y), 2);
  EXPECT_NEAR(cloud.points.back().x, flame.base_x + flame.reach(flame.base_y), 2);
  EXPECT_NEAR(cloud.base_x, flame.base_x, 0.3);
  EXPECT_NEAR(cloud.base_y, flame.base_y, 2);
}

TEST(EdgeCloud, TheBaseStaysWhereItIsWhileTheFlameSways) {
  double left = 1e9, right = 0, top = 1e9, bottom = 0;
  for (int k = 0; k < 60; ++k) {
    const EdgeCloud cloud = cloud_of(flame_picture(support::swaying(k)), kLevel);
    left = std::min(left, cloud.base_x);
    right = std::max(right, cloud.base_x);
    top = std::min(top, cloud.base_y);
    bottom = std::max(bottom, cloud.base_y);
  }
  EXPECT_LT(right - left, 1.0);
  EXPECT_LT(bottom - top, 1.0);
}

TEST(EdgeCloud, WhereThePictureCutsTheBaseOffItsEdgeIsTheBase) {
  Flame flame;
  flame.base_y = 200;  // below the picture's last row, 179
  const EdgeCloud cloud = cloud_of(flame_picture(flame), kLevel);
  EXPECT_NEAR(cloud.base_y, 179, 1);
  EXPECT_NEAR(cloud.base_x, flame.middle(179), 0.5);
  EXPECT_NEAR(cloud.points.back().x - cloud.points.front().x, 2 * flame.reach(179), 1.5);
}

TEST(EdgeCloud, AForkedBaseIsClosedFromFootToFootOrFollowed) {
  Plane plane = flame_picture(Flame{});
  for (int y = 130; y < 160; ++y) plane.fill({80 - (y - 130) / 3, y, 2 * ((y - 130) / 3) + 1, 1}, 8);
  const EdgeCloud closed = cloud_of(plane, kLevel);
  EXPECT_GT(closed.left_out, 100);
  EdgeCloudOptions options;
  options.underside = true;
  const EdgeCloud followed = cloud_of(plane, kLevel, options);
  EXPECT_EQ(followed.left_out, 0);
  EXPECT_NEAR(followed.points.front().y, 131, 3);
  EXPECT_NEAR(closed.area - followed.area, closed.left_out, 0.1 * closed.left_out);
  EXPECT_NEAR(followed.base_y, closed.base_y, 0.5);
}

TEST(EdgeCloud, APointedFootIsBothCorners) {
  Plane plane(160, 180, 8);
  support::paint(plane, 230, 3.0, [](double x, double y) {
    const double up = (150 - y) / 110;
    return up < 0 || up > 1 ? -5 : 25 * std::sin(std::numbers::pi * up) - std::abs(x - 80);
  });
  const EdgeCloud cloud = cloud_of(plane, kLevel);
  ASSERT_FALSE(cloud.points.empty());
  EXPECT_NEAR(cloud.base_x, 80, 2);
  EXPECT_NEAR(cloud.base_y, 148, 3);
  EXPECT_NEAR(cloud.area, 2 * 25 * 110 * 2 / std::numbers::pi, 150);
}

TEST(EdgeCloud, LandmarksLieWhereTheOptionsSay) {
  EdgeCloudOptions options;
  options.landmarks = {0, 0.3, 1};
  const EdgeCloud cloud = cloud_of(flame_picture(Flame{}), kLevel, options);
  const auto tip = std::min_element(cloud.points.begin(), cloud.points.end(),
                                    [](const EdgePoint& a, const EdgePoint& b) { return a.y < b.y; });
  EXPECT_NEAR(cloud.s[static_cast<std::size_t>(tip - cloud.points.begin())], 0.3, 0.02);
}

TEST(EdgeCloud, APaceMovesTheParameterNotThePoints) {
  EdgeCloudOptions options;
  options.pace = {0, 0.2, 1};
  const EdgeCloud even = cloud_of(flame_picture(Flame{}), kLevel);
  const EdgeCloud paced = cloud_of(flame_picture(Flame{}), kLevel, options);
  ASSERT_EQ(even.points.size(), paced.points.size());
  for (std::size_t k = 0; k < even.s.size(); ++k) {
    EXPECT_NEAR(paced.s[k], even.s[k] < 0.5 ? 0.4 * even.s[k] : 0.2 + 1.6 * (even.s[k] - 0.5), 1e-12);
  }
}

TEST(EdgeCloud, AThingHeldOnTheLeftIsSeenTheSameTurned) {
  const Plane upright = flame_picture(Flame{});
  Plane lying(upright.height, upright.width);
  for (int y = 0; y < lying.height; ++y) {
    for (int x = 0; x < lying.width; ++x) lying.at(x, y) = upright.pixels[(179 - x) * 160 + y];  // a quarter clockwise
  }
  EdgeCloudOptions options;
  options.base = BaseSide::kLeft;
  const EdgeCloud a = cloud_of(upright, kLevel), b = cloud_of(lying, kLevel, options);
  EXPECT_NEAR(b.height, a.height, 0.5);
  EXPECT_NEAR(b.base_x, 179 - a.base_y, 0.5);
  EXPECT_NEAR(b.base_y, a.base_x, 0.5);
  EXPECT_NEAR(b.area, a.area, 5);
}

TEST(EdgeCloud, ASpeckIsNoOutline) {
  Plane plane(20, 20);
  plane.fill({5, 5, 2, 2}, 255);
  EXPECT_TRUE(cloud_of(plane, 100).points.empty());
}

}  // namespace
}  // namespace wisp::edge_cloud_test
