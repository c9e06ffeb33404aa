#include "capture/vision/survey.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "capture/support/synthetic.hpp"

namespace wisp::survey_test {
namespace {

using support::Flame;
using support::Plane;

// Pictures that keep their pixels.
struct Clip {
  std::deque<Plane> planes;
  std::vector<Picture> pictures;
  void add(Plane plane) {
    planes.push_back(std::move(plane));
    pictures.push_back(grey_picture(planes.back().view()));
  }
};

Flame on_the_left(int k) {
  Flame flame = support::swaying(k);
  flame.base_x = 60;
  return flame;
}

TEST(Survey, TheThingIsWhatMovesNotTheLargerThingThatStandsStill) {
  Clip clip;
  for (int k = 0; k < 20; ++k) {
    Plane plane = support::flame_picture(on_the_left(k), 240, 180);
    plane.fill({140, 60, 90, 100}, 200);  // wax, brighter in sum than the flame
    plane.fill({10, 5, 12, 12}, 255);     // a reflection
    clip.add(std::move(plane));
  }
  const auto surveys = survey_scene(clip.pictures, {});
  ASSERT_TRUE(surveys);
  const Survey& survey = *surveys;
  EXPECT_LT(survey.home.right(), 130);
  EXPECT_GT(survey.home.height, 90);
  EXPECT_EQ(survey.flames, 1);
  EXPECT_GT(survey.change, 0.05);
}

TEST(Survey, TheLevelPartsFlameAndGround) {
  Clip clip;
  for (int k = 0; k < 10; ++k) clip.add(support::flame_picture(support::swaying(k)));
  const Survey survey = survey_scene(clip.pictures, {}).value();
  EXPECT_GT(survey.level, 60);
  EXPECT_LT(survey.level, 220);
}

TEST(Survey, PicturesOfAFadeDoNotCount) {
  Clip bright, faded;
  for (int k = 0; k < 20; ++k) {
    bright.add(support::flame_picture(support::swaying(k)));
    faded.add(support::flame_picture(support::swaying(k), 160, 180, k < 6 ? 30 * k : 230));
  }
  EXPECT_NEAR(survey_scene(faded.pictures, {})->level, survey_scene(bright.pictures, {}).value().level, 3);
}

TEST(Survey, PicturesOfATitleDoNotCount) {
  Clip plain, titled;
  for (int k = 0; k < 20; ++k) {
    plain.add(support::flame_picture(support::swaying(k)));
    titled.add(k < 8 ? Plane(160, 180, 235) : support::flame_picture(support::swaying(k)));
  }
  const auto survey = survey_scene(titled.pictures, {});
  ASSERT_TRUE(survey);
  EXPECT_NEAR(survey->level, survey_scene(plain.pictures, {}).value().level, 3);
  EXPECT_EQ(survey->seen.size(), 12u);
}

TEST(Survey, ALampFilmedFromAHandIsNoOtherFlame) {
  Clip clip;
  for (int k = 0; k < 20; ++k) {
    Flame flame = support::swaying(k);
    const double x = 4 * std::sin(1.9 * k), y = 4 * std::sin(1.3 * k);
    flame.base_x = 200 + x, flame.base_y = 130 + y;
    flame.height *= 0.36, flame.half_width *= 0.3, flame.lean *= 0.5;
    Plane plane = support::flame_picture(flame, 480, 180);
    support::paint(plane, 230, 1.0, [&](double px, double py) { return 33 - std::hypot(px - 380 - x, py - 60 - y); });
    clip.add(std::move(plane));
  }
  const auto survey = survey_scene(clip.pictures, {});
  ASSERT_TRUE(survey);
  EXPECT_EQ(survey->flames, 1);
  EXPECT_LT(survey->home.x, 200);
}

// A flame that is wider in red than in green, over twenty pictures in which its tip sways by `sway` pixels, and its
// green by `green` times as much.
PixelChannel channel_of_coloured(double sway, double green) {
  std::deque<std::vector<std::uint8_t>> kept;
  std::vector<Picture> pictures;
  for (int k = 0; k < 20; ++k) {
    Flame red, core;
    red.lean = sway * std::sin(0.9 * k);
    core.half_width = 0.8 * red.half_width, core.height = 0.9 * red.height;
    core.lean = green * red.lean;
    const Plane wide = support::flame_picture(red, 160, 180, 250), narrow = support::flame_picture(core, 160, 180, 250);
    std::vector<std::uint8_t> rgb;
    for (std::size_t i = 0; i < wide.pixels.size(); ++i) {
      rgb.insert(rgb.end(), {wide.pixels[i], narrow.pixels[i], std::uint8_t{8}});
    }
    kept.push_back(std::move(rgb));
    pictures.push_back(rgb_picture({kept.back().data(), 160, 180, 3 * 160}, 3));
  }
  return survey_scene(pictures, {}).value().channel;
}

TEST(Survey, AFlameThatStandsNearlyStillIsLookedAtInTheChannelThatShowsMostOfIt) {
  EXPECT_EQ(channel_of_coloured(15, 1), PixelChannel::kRed);
  EXPECT_EQ(channel_of_coloured(2, 1), PixelChannel::kRed);
  EXPECT_EQ(channel_of_coloured(2, 2), PixelChannel::kRed);
  EXPECT_EQ(channel_of_coloured(1, 3), PixelChannel::kRed);
}

TEST(Survey, DarkThingsAreFoundOnLightGround) {
  Clip clip;
  for (int k = 0; k < 10; ++k) {
    Plane plane = support::flame_picture(support::swaying(k));
    for (auto& pixel : plane.pixels) pixel = static_cast<std::uint8_t>(255 - pixel);
    clip.add(std::move(plane));
  }
  const auto surveys = survey_scene(clip.pictures, {.dark = true});
  ASSERT_TRUE(surveys);
  EXPECT_NEAR(surveys->home.height, 120, 12);
}

TEST(Survey, OneBrightnessHoldsNothing) {
  Clip clip;
  for (int k = 0; k < 10; ++k) clip.add(Plane(160, 120, 16));
  const auto surveys = survey_scene(clip.pictures, {});
  ASSERT_FALSE(surveys);
  EXPECT_NE(surveys.error().message.find("one brightness"), std::string::npos);
}

TEST(BaseSide, IsBelowUnlessAnotherSideCutsTheThingOff) {
  const Region area{0, 0, 100, 100};
  Survey survey;
  survey.seen.assign(10, {40, 0, 20, 60});  // a flame that reaches the upper border now and then
  survey.seen[3].y = 5;
  EXPECT_EQ(base_side(survey, area), BaseSide::kBottom);
  survey.seen.assign(10, {0, 40, 60, 20});
  EXPECT_EQ(base_side(survey, area), BaseSide::kLeft);
  survey.seen.assign(10, {0, 40, 60, 60});
  EXPECT_EQ(base_side(survey, area), BaseSide::kBottom);
}

TEST(BaseSide, OfAThingThatLiesOnItsSideIsTheEndThatMovesLess) {
  Survey survey;
  for (int k = 0; k < 10; ++k) survey.seen.push_back({20 + 3 * (k % 3), 40, 50 - 3 * (k % 3), 10});
  EXPECT_EQ(base_side(survey, {0, 0, 100, 100}), BaseSide::kRight);
}

}  // namespace
}  // namespace wisp::survey_test
