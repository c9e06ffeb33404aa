#include "capture/vision/waist.hpp"

#include <gtest/gtest.h>

#include "capture/support/synthetic.hpp"

namespace wisp {
namespace {

using support::Plane;

// A thing 20 wide down to row 60, a bridge of `bridge` pixels, and what it stands on.
Plane on_a_stand(int bridge) {
  Plane plane(80, 100);
  plane.fill({30, 10, 20, 50}, 200);
  plane.fill({40 - bridge / 2, 60, bridge, 6}, 200);
  plane.fill({10, 66, 60, 20}, 200);
  return plane;
}

TEST(Waist, IsWhereThingAndStandMeet) {
  const Plane plane = on_a_stand(6);
  const auto waist = find_waist(plane.view(), 100, {10, 10, 60, 76}, 60, BaseSide::kBottom);
  ASSERT_TRUE(waist);
  EXPECT_GE(*waist, 60);
  EXPECT_LE(*waist, 66);
}

TEST(Waist, IsNotThereWhereTheThingOnlyGrew) {
  const Plane plane = on_a_stand(20);
  EXPECT_FALSE(find_waist(plane.view(), 100, {30, 10, 20, 56}, 58, BaseSide::kBottom));
}

TEST(Waist, IsFoundOnAnySide) {
  const Plane upright = on_a_stand(6);
  Plane lying(100, 80);
  for (int y = 0; y < 80; ++y) {
    for (int x = 0; x < 100; ++x) lying.at(x, y) = upright.pixels[(99 - x) * 80 + y];
  }
  const auto waist = find_waist(lying.view(), 100, {14, 10, 76, 60}, 39, BaseSide::kLeft);
  ASSERT_TRUE(waist);
  EXPECT_LE(*waist, 39);
  EXPECT_GE(*waist, 33);
}

}  // namespace
}  // namespace wisp
