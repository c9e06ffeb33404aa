#include "capture/vision/region.hpp"

#include <gtest/gtest.h>

#include "capture/support/synthetic.hpp"

namespace wisp::shoulder_test {
namespace {

using support::Plane;

// A thing 20 wide down to row 60, a bridge of `bridge` pixels, and what it stands on from row 66 on.
Plane on_a_stand(int bridge) {
  Plane plane(80, 100);
  plane.fill({30, 10, 20, 50}, 200);
  plane.fill({40 - bridge / 2, 60, bridge, 6}, 200);
  plane.fill({10, 66, 60, 20}, 200);
  return plane;
}

Profile profile_in(const Plane& plane, BaseSide side) {
  RegionFinder finder;
  const BrightRegion region = finder.find(plane.view(), 100, 1).front();
  std::vector<PixelPosition> boundary;
  follow_boundary(plane.view(), 100, {region.seed_x, region.seed_y}, boundary);
  Profile profile;
  measure_profile(boundary, side, profile);
  return profile;
}

TEST(Shoulder, IsWhereTheStandBegins) {
  for (const int bridge : {6, 20}) {
    const auto shoulder = find_shoulder(profile_in(on_a_stand(bridge), BaseSide::kBottom), 0);
    ASSERT_TRUE(shoulder) << bridge;
    EXPECT_GE(*shoulder, 50u);
    EXPECT_LE(*shoulder, 55u);
  }
}

TEST(Shoulder, IsNotInASlantedOrPointedBase) {
  Plane plane(80, 100);
  for (int y = 10; y < 80; ++y) plane.fill({30, y, y < 60 ? 20 : 80 - y, 1}, 200);
  EXPECT_FALSE(find_shoulder(profile_in(plane, BaseSide::kBottom), 0));
}

TEST(Shoulder, IsNotInABluntTip) {
  Plane plane(120, 100);
  for (int y = 10; y < 90; ++y) plane.fill({y < 14 ? 55 : 40, y, y < 14 ? 10 : 40, 1}, 200);
  EXPECT_FALSE(find_shoulder(profile_in(plane, BaseSide::kBottom), 0));
}

TEST(Shoulder, IsLookedForOnlyFromWhereItIsAsked) {
  EXPECT_FALSE(find_shoulder(profile_in(on_a_stand(6), BaseSide::kBottom), 60));
}

TEST(Shoulder, IsFoundOnAnySide) {
  const Plane upright = on_a_stand(6);
  Plane lying(100, 80);
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 100; ++x) lying.at(x, y) = upright.pixels[(99 - x) * 80 + y];
  }
  const Profile profile = profile_in(lying, BaseSide::kLeft);
  const auto shoulder = find_shoulder(profile, 0);
  ASSERT_TRUE(shoulder);
  const int edge = depth_of(profile.first + static_cast<int>(*shoulder), BaseSide::kLeft);
  EXPECT_GE(edge, 33);
  EXPECT_LE(edge, 39);
}

}  // namespace
}  // namespace wisp::shoulder_test
