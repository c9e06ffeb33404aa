#include "wisp/draw/film_strip.hpp"

#include <gtest/gtest.h>

#include "draw/draw_test_pictures.hpp"

namespace wisp::film_strip_test {
namespace {

constexpr Colour kRed{200, 10, 10, 255};
constexpr Colour kGreen{10, 200, 10, 255};
constexpr Colour kBlue{10, 10, 200, 255};

int pixels_of(const Image& image, Colour colour) {
  int count = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) count += image.at(x, y) == colour ? 1 : 0;
  }
  return count;
}

PixelBox box_of(const Image& image, Colour colour) {
  int left = image.width(), top = image.height(), right = -1, bottom = -1;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (image.at(x, y) != colour) continue;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = std::max(bottom, y);
    }
  }
  return {left, top, right - left + 1, bottom - top + 1};
}

TEST(FilmStrip, ShowsEveryFrameWholeInItsPlace) {
  FilmStrip strip;
  strip.frame_height = 60;
  strip.rows = {{"Real", {Image(80, 60, kRed), Image(80, 60, kGreen)}}, {"Synthesized", {Image(80, 60, kBlue)}}};
  const auto image = draw_film_strip(strip);
  ASSERT_TRUE(image);
  EXPECT_EQ(pixels_of(*image, kRed), 80 * 60);
  EXPECT_EQ(pixels_of(*image, kGreen), 80 * 60);
  EXPECT_EQ(pixels_of(*image, kBlue), 80 * 60);
  const PixelBox red = box_of(*image, kRed);
  const PixelBox green = box_of(*image, kGreen);
  const PixelBox blue = box_of(*image, kBlue);
  EXPECT_EQ(green.x, red.x + 80 + 4);
  EXPECT_EQ(green.y, red.y);
  EXPECT_EQ(blue.x, red.x);
  EXPECT_GT(blue.y, red.y + 60);
}

TEST(FilmStrip, ScalesFramesToOneHeightAndKeepsTheirProportions) {
  FilmStrip strip;
  strip.frame_height = 50;
  strip.rows = {{"", {Image(200, 100, kRed), Image(50, 100, kGreen)}}};
  const auto image = draw_film_strip(strip);
  ASSERT_TRUE(image);
  const PixelBox red = box_of(*image, kRed);
  EXPECT_EQ(red.width, 100);
  EXPECT_EQ(red.height, 50);
  const PixelBox green = box_of(*image, kGreen);
  EXPECT_EQ(green.width, 25);
  EXPECT_EQ(green.height, 50);
}

TEST(FilmStrip, AnEmptyFrameLeavesItsPlaceDark) {
  FilmStrip strip;
  strip.frame_height = 40;
  strip.rows = {{"", {Image(), Image(40, 40, kRed)}}};
  const auto image = draw_film_strip(strip);
  ASSERT_TRUE(image);
  const PixelBox red = box_of(*image, kRed);
  EXPECT_GT(red.x, 40);
  EXPECT_LT(brightness_at(*image, red.x - 20, red.y + 20), 60);
}

TEST(FilmStrip, CaptionsAndTimesTakeRoomOfTheirOwn) {
  FilmStrip strip;
  strip.rows = {{"", {Image(100, 100, kRed)}}};
  const auto bare = draw_film_strip(strip);
  strip.rows[0].caption = "Real";
  const auto captioned = draw_film_strip(strip);
  strip.times = {"0.00 s", "of a column that is not there"};
  const auto timed = draw_film_strip(strip);
  ASSERT_TRUE(bare && captioned && timed);
  EXPECT_GT(captioned->height(), bare->height() + 10);
  EXPECT_GT(timed->height(), captioned->height() + 15);
  EXPECT_EQ(timed->width(), bare->width());
  EXPECT_EQ(pixels_of(*timed, kRed), pixels_of(*bare, kRed));
}

TEST(FilmStrip, WithoutFramesThereIsNone) {
  EXPECT_FALSE(draw_film_strip({}));
  FilmStrip strip;
  strip.rows = {{"Real", {}}, {"Synthesized", {Image()}}};
  const auto image = draw_film_strip(strip);
  ASSERT_FALSE(image);
  EXPECT_NE(image.error().message.find("no frames"), std::string::npos);
}

TEST(FilmStrip, OneThatIsTooLongSaysSo) {
  FilmStrip strip;
  strip.frame_height = 400;
  strip.rows = {{"", std::vector<Image>(100, Image(400, 400, kRed))}};
  const auto image = draw_film_strip(strip);
  ASSERT_FALSE(image);
  EXPECT_NE(image.error().message.find("fewer or smaller"), std::string::npos);
}

TEST(FilmStrip, DrawsTheSameTwice) {
  FilmStrip strip;
  strip.rows = {{"Real", {Image(123, 77, kRed)}}};
  strip.times = {"1 s"};
  EXPECT_TRUE(*draw_film_strip(strip) == *draw_film_strip(strip));
}

}  // namespace
}  // namespace wisp::film_strip_test
