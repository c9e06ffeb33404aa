#include "wisp/draw/live_flames.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "draw/draw_test_pictures.hpp"

namespace wisp::live_flames_test {
namespace {

constexpr int kWidth = 401;  // no multiple of the grid's cells
constexpr int kHeight = 303;

Image drawn_once(std::span<const Flame> flames, const FlameStyle& style = {}) {
  Image image(kWidth, kHeight);
  draw_room(image, flames, style);
  draw_flames(image, flames, style);
  return image;
}

Image drawn_live(std::span<const Flame> flames, const FlameStyle& style = {}) {
  LiveFlames live(kWidth, kHeight, style);
  Image image;
  live.draw(image, flames);
  return image;
}

// Pixels of which a channel differs by more than that many codes.
int differing(const Image& a, const Image& b, int codes) {
  int count = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      const Colour p = a.at(x, y), q = b.at(x, y);
      count +=
          std::max({std::abs(p.red - q.red), std::abs(p.green - q.green), std::abs(p.blue - q.blue)}) > codes ? 1 : 0;
    }
  }
  return count;
}

FlameScene scene_at(float x, float unit) {
  FlameScene scene;
  scene.base = {x, 230};
  scene.pixels_per_unit = unit;
  return scene;
}

TEST(LiveFlames, AreThePictureOfDrawFlames) {
  const auto leaning = drop_outline(0.3F);
  // A unit of 200 pixels has a glow that fits the coarse grid, one of 60 has rings that do not.
  for (const float unit : {200.0F, 60.0F}) {
    const std::vector<Flame> flames{{leaning, scene_at(120, unit)}, {leaning, scene_at(300, unit)}};
    EXPECT_EQ(differing(drawn_live(flames), drawn_once(flames), 5), 0) << unit;
    EXPECT_LT(differing(drawn_live(flames), drawn_once(flames), 3), kWidth * kHeight / 200) << unit;
    EXPECT_LT(differing(drawn_live(flames), drawn_once(flames), 1), kWidth * kHeight / 50) << unit;
  }
}

TEST(LiveFlames, AreSoBesideTwoOthersWhoseGlowsMeet) {
  const auto small = drop_outline(0, 0.6F, 0.2F);
  std::vector<Flame> flames;
  // The glows of the last two meet, and the box around both reaches into the first, which neither meets.
  for (const Point base : {Point{185, 160}, Point{200, 270}, Point{238, 190}}) {
    FlameScene scene = scene_at(base.x, 100);
    scene.base = base;
    flames.push_back({small, scene});
  }
  EXPECT_EQ(differing(drawn_live(flames), drawn_once(flames), 5), 0);
}

TEST(LiveFlames, AreSoWithSmokeAndEmber) {
  const auto calm = drop_outline();
  FlameScene out = scene_at(140, 150);
  out.seconds_since_out = 1.2F;
  const std::vector<Flame> flames{{calm, out}, {calm, scene_at(290, 150)}};
  EXPECT_EQ(differing(drawn_live(flames), drawn_once(flames), 3), 0);
}

TEST(LiveFlames, AreSoAtThePicturesEdge) {
  const auto calm = drop_outline();
  const std::vector<Flame> flames{{calm, scene_at(4, 180)}, {calm, scene_at(1000, 180)}};
  EXPECT_EQ(differing(drawn_live(flames), drawn_once(flames), 3), 0);
}

TEST(LiveFlames, ForgetThePictureBefore) {
  const auto calm = drop_outline();
  const std::vector<Flame> left{{calm, scene_at(100, 150)}}, right{{calm, scene_at(120, 150)}};
  LiveFlames live(kWidth, kHeight);
  Image image;
  live.draw(image, left);
  live.draw(image, right);
  EXPECT_EQ(image, drawn_live(right));
  live.draw(image, {});
  Image night(kWidth, kHeight);
  draw_room(night, {});
  EXPECT_EQ(image, night);
}

}  // namespace
}  // namespace wisp::live_flames_test
