#include "capture/vision/scene_light.hpp"

#include <gtest/gtest.h>

#include "capture/support/synthetic.hpp"

namespace wisp::scene_light_test {
namespace {

using support::Plane;

// A dim wall with a bright thing at x.
Plane scene(int x, int value = 230, std::uint8_t wall = 40) {
  Plane plane(320, 180, wall);
  if (value > 0) plane.fill({x, 60, 30, 80}, static_cast<std::uint8_t>(value));
  return plane;
}

TEST(SceneLight, NothingIsAnotherSceneBeforeOneIsKnown) {
  SceneLight light;
  EXPECT_FALSE(light.another(grey_picture(scene(60).view())));
}

TEST(SceneLight, ASceneWhoseFlameWentOutIsTheSame) {
  SceneLight light;
  light.remember(grey_picture(scene(60).view()));
  EXPECT_FALSE(light.another(grey_picture(scene(60, 0, 32).view())));
  EXPECT_FALSE(light.another(grey_picture(scene(60, 0, 0).view())));
}

TEST(SceneLight, LightWhereNoneWasIsAnotherScene) {
  SceneLight light;
  light.remember(grey_picture(scene(60, 230, 20).view()));
  EXPECT_TRUE(light.another(grey_picture(scene(200, 230, 20).view())));
  EXPECT_TRUE(light.another(grey_picture(scene(60, 0, 120).view())));
}

TEST(SceneLight, ASparkInTheDarkIsNoScene) {
  SceneLight light;
  light.remember(grey_picture(scene(60, 230, 10).view()));
  Plane spark(320, 180, 10);
  spark.fill({200, 60, 3, 3}, 255);
  EXPECT_FALSE(light.another(grey_picture(spark.view())));
}

TEST(SceneLight, WhereTheFlameWasInAnyPictureIsNotNew) {
  SceneLight light;
  for (const int x : {60, 100, 140}) light.remember(grey_picture(scene(x, 230, 20).view()));
  EXPECT_FALSE(light.another(grey_picture(scene(100, 230, 20).view())));
}

}  // namespace
}  // namespace wisp::scene_light_test
