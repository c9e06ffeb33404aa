#include "capture/vision/film_look.hpp"

#include <gtest/gtest.h>

#include "capture/support/synthetic.hpp"

namespace wisp::film_look_test {
namespace {

using support::Plane;

constexpr Region kAll{0, 0, 320, 180};

// A dim wall with a bright thing at x.
Plane scene(int x, int value = 230, std::uint8_t wall = 40) {
  Plane plane(320, 180, wall);
  if (value > 0) plane.fill({x, 60, 30, 80}, static_cast<std::uint8_t>(value));
  return plane;
}

TEST(FilmLook, NothingIsAnotherSceneBeforeOneIsKnown) {
  FilmLook light;
  EXPECT_FALSE(light.another(grey_picture(scene(60).view()), kAll));
}

TEST(FilmLook, ASceneWhoseFlameWentOutIsTheSame) {
  FilmLook light;
  light.remember(grey_picture(scene(60).view()));
  EXPECT_FALSE(light.another(grey_picture(scene(60, 0, 32).view()), kAll));
  EXPECT_FALSE(light.another(grey_picture(scene(60, 0, 0).view()), kAll));
}

TEST(FilmLook, LightWhereNoneWasIsAnotherScene) {
  FilmLook light;
  light.remember(grey_picture(scene(60, 230, 20).view()));
  EXPECT_TRUE(light.another(grey_picture(scene(200, 230, 20).view()), kAll));
  EXPECT_TRUE(light.another(grey_picture(scene(60, 0, 120).view()), kAll));
}

TEST(FilmLook, ByDayWhatBurnsElsewhereIsNewInItsOwnPlace) {
  FilmLook light;
  light.remember(grey_picture(scene(60, 230, 120).view()));
  EXPECT_FALSE(light.another(grey_picture(scene(200, 230, 120).view()), kAll));
  EXPECT_TRUE(light.another(grey_picture(scene(200, 230, 120).view()), {200, 60, 30, 80}));
  EXPECT_FALSE(light.another(grey_picture(scene(60, 230, 120).view()), {60, 60, 30, 80}));
}

TEST(FilmLook, ASparkInTheDarkIsNoScene) {
  FilmLook light;
  light.remember(grey_picture(scene(60, 230, 10).view()));
  Plane spark(320, 180, 10);
  spark.fill({200, 60, 3, 3}, 255);
  EXPECT_FALSE(light.another(grey_picture(spark.view()), kAll));
}

TEST(FilmLook, WhereTheFlameWasInAnyPictureIsNotNew) {
  FilmLook light;
  for (const int x : {60, 100, 140}) light.remember(grey_picture(scene(x, 230, 20).view()));
  EXPECT_FALSE(light.another(grey_picture(scene(100, 230, 20).view()), kAll));
}

TEST(FilmLook, AtACutPicturesAreUnlikeAndWhereAFlameIsLitTheyAreNot) {
  FilmLook film;
  for (int k = 0; k < 60; ++k) film.look(grey_picture(scene(k < 25 ? 60 + k % 3 : 220 - k % 3).view()));
  EXPECT_EQ(film.facts().cuts, std::vector<std::size_t>{25});
  FilmLook lit;
  for (int k = 0; k < 60; ++k) lit.look(grey_picture(scene(60, k < 25 ? 0 : 230, k < 25 ? 20 : 40).view()));
  EXPECT_TRUE(lit.facts().cuts.empty());
}

TEST(FilmLook, LostFramesCountInTheRowsOfCuts) {
  FilmLook film;
  for (int k = 0; k < 50; ++k) {
    film.look(grey_picture(scene(k < 25 ? 60 : 220).view()));
    if (k == 10) film.lost();
  }
  EXPECT_EQ(film.facts().cuts, std::vector<std::size_t>{26});
}

TEST(FilmLook, AMovingCameraIsToldFromAMovingThing) {
  FilmLook moved, still;
  for (int k = 0; k < 60; ++k) {
    const int x = 100 + k * k % 40;
    moved.look(grey_picture(scene(x).view()));
    Plane plane = scene(100);
    plane.fill({105, 60 - k * k % 20, 20, 20}, 230);
    still.look(grey_picture(plane.view()));
  }
  EXPECT_GT(moved.facts().camera, 0.02);
  EXPECT_LT(still.facts().camera, 0.01);
}

TEST(FilmLook, LightIsOfAllPictures) {
  FilmLook film;
  for (int k = 0; k < 9; ++k) film.look(grey_picture(scene(60, k == 4 ? 255 : 100, 30).view()));
  EXPECT_EQ(film.facts().brightest, 255);
  EXPECT_EQ(film.facts().flat, 0);
}

}  // namespace
}  // namespace wisp::film_look_test
