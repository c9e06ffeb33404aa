#include "capture/vision/candle_look.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace wisp::candle_look_test {
namespace {

using Rgb = std::array<std::uint8_t, 3>;

// A flame of 40 x 100 pixels at (200, 60) over a candle whose top is at 165, in a picture of 440 x 300.
struct Scene {
  int candle_width = 60;
  Rgb wax{200, 60, 40};
  Rgb ground{8, 6, 6};
  std::vector<std::uint8_t> pixels{};

  static constexpr Region kFlame{200, 60, 40, 100};

  Picture picture() {
    pixels.clear();
    for (int y = 0; y < 300; ++y) {
      for (int x = 0; x < 440; ++x) {
        const bool flame = x >= 200 && x < 240 && y >= 60 && y < 160;
        const bool candle = y >= 165 && std::abs(2 * x + 1 - 440) < candle_width;
        const Rgb colour = flame ? Rgb{255, 220, 120} : candle ? wax : ground;
        pixels.insert(pixels.end(), colour.begin(), colour.end());
      }
    }
    return rgb_picture({pixels.data(), 440, 300, 3 * 440}, 3);
  }

  std::optional<CandleLook> look() {
    const Picture one = picture();
    return look_of_candle({&one, 1}, kFlame);
  }
};

TEST(CandleLook, HasTheCandlesWidthAndColour) {
  for (const int width : {30, 60, 200}) {
    Scene scene{.candle_width = width};
    const auto look = scene.look();
    ASSERT_TRUE(look) << width;
    EXPECT_NEAR(look->width, width / 100.0, 0.011);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(look->rgb[k], scene.wax[k], 1e-9);
  }
}

TEST(CandleLook, IsNothingWhereNothingIsSeenBelowTheFlame) {
  EXPECT_FALSE((Scene{.wax = {8, 6, 6}}.look()));                                  // a flame on black
  EXPECT_FALSE((Scene{.candle_width = 440, .wax = {120, 110, 100}}.look()));       // a lit table, to both sides
  EXPECT_FALSE((Scene{.wax = {120, 110, 100}, .ground = {118, 109, 99}}.look()));  // before a wall as bright
}

TEST(CandleLook, IsNothingWhereThePictureEndsBelowTheFlameOrHasNoColour) {
  Scene scene;
  const Picture one = scene.picture();
  EXPECT_FALSE(look_of_candle({&one, 1}, {200, 200, 40, 100}));
  EXPECT_FALSE(look_of_candle({}, Scene::kFlame));
  const std::vector<std::uint8_t> grey(440 * 300, 90);
  const Picture plain = grey_picture({grey.data(), 440, 300, 440});
  EXPECT_FALSE(look_of_candle({&plain, 1}, Scene::kFlame));
}

}  // namespace
}  // namespace wisp::candle_look_test
