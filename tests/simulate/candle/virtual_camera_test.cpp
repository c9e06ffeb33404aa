#include "simulate/candle/virtual_camera.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace wisp::virtual_camera_test {
namespace {

using testing::HasSubstr;

// A round light of the given radius, 20 mm above the rim, and blue below it.
RigLight lamp(float brightness) {
  RigLight light{64, 128, 2.0 / 3, 15, 10, {}, {}};
  for (int j = 0; j < light.rows; ++j)
    for (int i = 0; i < light.columns; ++i) {
      const double x = (i + 0.5) * light.cell_mm - light.wick_x_mm;
      const double y = (j + 0.5) * light.cell_mm - light.wick_y_mm;
      light.soot.push_back(std::hypot(x, y - 20) < 5 ? brightness : 0.0F);
      light.blue.push_back(std::hypot(x, y - 4) < 2 ? 30.0F * brightness : 0.0F);
    }
  return light;
}

struct Pixel {
  int red, green, blue;
};

Pixel pixel(const VirtualCamera& camera, std::span<const std::uint8_t> picture, double x_mm, double y_mm) {
  const CameraView view = camera.view();
  const auto x = static_cast<std::size_t>(std::lround(view.pixel_x(x_mm)));
  const auto y = static_cast<std::size_t>(std::lround(view.pixel_y(y_mm)));
  const std::size_t k = 3 * (y * static_cast<std::size_t>(camera.options().width) + x);
  return {picture[k], picture[k + 1], picture[k + 2]};
}

TEST(VirtualCamera, ShowsGlowingSootAsYellowWhiteAndTheReactionAsFaintBlue) {
  VirtualCamera camera = std::move(*VirtualCamera::create({.noise = 0}));
  const auto picture = camera.picture(lamp(1), 0);
  const Pixel body = pixel(camera, picture, 0, 20);
  EXPECT_GT(body.red, 240);
  EXPECT_GT(body.green, 200);
  EXPECT_GT(body.red, body.green);
  EXPECT_GT(body.green, body.blue);
  EXPECT_GT(body.blue, 100);
  const Pixel base = pixel(camera, picture, 0, 4);
  EXPECT_GT(base.blue, 60);
  EXPECT_GT(base.blue, 2 * base.green);
  EXPECT_GT(base.green, base.red);
}

TEST(VirtualCamera, LeavesAllElseBlack) {
  VirtualCamera camera = std::move(*VirtualCamera::create({.noise = 0}));
  const auto picture = camera.picture(lamp(1), 0);
  for (const auto& [x, y] : {std::pair{0.0, -2.0}, {15.0, 20.0}, {0.0, 40.0}})
    EXPECT_LT(pixel(camera, picture, x, y).red, 12) << x << ", " << y;
  const auto dark = camera.picture(lamp(0), 1);
  for (const std::uint8_t value : dark) ASSERT_EQ(value, 0);
}

TEST(VirtualCamera, NoiseIsAsLargeAsAskedAndNewInEveryFrame) {
  VirtualCamera camera = std::move(*VirtualCamera::create({.glow = 0, .noise = 4}));
  RigLight grey = lamp(0);
  for (float& value : grey.soot) value = 0.4F;
  const auto first = camera.picture(grey, 0);
  double sum = 0;
  double squares = 0;
  int count = 0;
  std::vector<int> kept;
  for (int y = 200; y < 260; ++y)
    for (int x = 100; x < 200; ++x) {
      const int value = first[3 * (static_cast<std::size_t>(y) * 320 + x)];
      kept.push_back(value);
      sum += value;
      squares += value * value;
      ++count;
    }
  const double mean = sum / count;
  EXPECT_NEAR(std::sqrt(squares / count - mean * mean), 4, 0.4);
  const auto second = camera.picture(grey, 1);
  int same = 0;
  for (int y = 200, k = 0; y < 260; ++y)
    for (int x = 100; x < 200; ++x, ++k) same += kept[k] == second[3 * (static_cast<std::size_t>(y) * 320 + x)];
  EXPECT_LT(same, count / 5);
}

TEST(VirtualCamera, ThePictureOfAFrameIsAlwaysTheSame) {
  VirtualCamera a = std::move(*VirtualCamera::create());
  VirtualCamera b = std::move(*VirtualCamera::create());
  b.picture(lamp(0.3F), 4);
  const auto first = a.picture(lamp(1), 7);
  const auto second = b.picture(lamp(1), 7);
  EXPECT_TRUE(std::equal(first.begin(), first.end(), second.begin()));
}

TEST(VirtualCamera, SaysWhichOptionIsWrong) {
  EXPECT_THAT(VirtualCamera::create({.width = 321}).error().message, HasSubstr("even"));
  EXPECT_THAT(VirtualCamera::create({.gain = -1}).error().message, HasSubstr("gain"));
}

}  // namespace
}  // namespace wisp::virtual_camera_test
