#include "wisp/draw/image.hpp"

#include <gtest/gtest.h>

#include "draw/draw_test_pictures.hpp"
#include "wisp/base/file.hpp"

namespace wisp::image_test {
namespace {

Image gradient(int width, int height) {
  std::vector<std::uint8_t> rgb;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      rgb.push_back(static_cast<std::uint8_t>(x * 7));
      rgb.push_back(static_cast<std::uint8_t>(y * 11));
      rgb.push_back(static_cast<std::uint8_t>(x * y));
    }
  }
  return Image::from_rgb(rgb, width, height);
}

TEST(Image, KeepsTheBytesItWasMadeFrom) {
  const std::vector<std::uint8_t> rgb{1, 2, 3, 4, 5, 6, 250, 251, 252, 0, 128, 255};
  const Image image = Image::from_rgb(rgb, 2, 2);
  EXPECT_EQ(image.at(0, 0), (Colour{1, 2, 3, 255}));
  EXPECT_EQ(image.at(1, 0), (Colour{4, 5, 6, 255}));
  EXPECT_EQ(image.at(0, 1), (Colour{250, 251, 252, 255}));
  EXPECT_EQ(image.at(1, 1), (Colour{0, 128, 255, 255}));
}

TEST(Image, StepsOverTheGapBetweenRows) {
  const std::vector<std::uint8_t> rgb{1, 2, 3, 99, 99, 4, 5, 6};
  const Image image = Image::from_rgb(rgb, 1, 2, 5);
  EXPECT_EQ(image.at(0, 1), (Colour{4, 5, 6, 255}));
}

TEST(Image, StoresColoursPremultipliedAndGivesThemBackStraight) {
  const Image image(1, 1, {200, 100, 50, 128});
  EXPECT_EQ(image.pixels()[0], 0x80643219U);
  const Colour colour = image.at(0, 0);
  EXPECT_NEAR(colour.red, 200, 1);
  EXPECT_NEAR(colour.green, 100, 1);
  EXPECT_NEAR(colour.blue, 50, 1);
  EXPECT_EQ(colour.opacity, 128);
}

TEST(Image, CropTakesThePartAndFillsTheOutsideWithBlack) {
  const Image image = gradient(20, 10);
  const Image part = crop(image, {15, 5, 10, 10});
  ASSERT_EQ(part.width(), 10);
  ASSERT_EQ(part.height(), 10);
  EXPECT_EQ(part.at(0, 0), image.at(15, 5));
  EXPECT_EQ(part.at(4, 4), image.at(19, 9));
  EXPECT_EQ(part.at(5, 0), (Colour{0, 0, 0, 255}));
  EXPECT_EQ(crop(image, {-3, -2, 4, 3}).at(3, 2), image.at(0, 0));
  EXPECT_EQ(crop(image, {500, 500, 2, 2}).at(1, 1), (Colour{0, 0, 0, 255}));
  EXPECT_EQ(crop(image, {2147483647, -2147483647, 2, 2}).at(1, 1), (Colour{0, 0, 0, 255}));
}

TEST(Image, ResizingKeepsAFlatColourUpToTheEdges) {
  const Image flat(31, 17, {90, 160, 40, 255});
  for (const auto& [width, height] : {std::pair{7, 5}, std::pair{100, 60}}) {
    const Image other = resized(flat, width, height);
    ASSERT_EQ(other.width(), width);
    ASSERT_EQ(other.height(), height);
    EXPECT_EQ(other.at(0, 0), flat.at(0, 0));
    EXPECT_EQ(other.at(width - 1, height - 1), flat.at(0, 0));
  }
}

TEST(Image, PngHasItsSizeInItsHeader) {
  const TestFolder folder("png-header");
  ASSERT_TRUE(write_png(folder / "a.png", gradient(300, 20)));
  const auto bytes = read_file(folder / "a.png");
  ASSERT_TRUE(bytes);
  const auto byte = [&](std::size_t k) { return std::to_integer<int>((*bytes)[k]); };
  ASSERT_GT(bytes->size(), 33U);
  EXPECT_EQ(byte(1), 'P');
  EXPECT_EQ(byte(18) * 256 + byte(19), 300);
  EXPECT_EQ(byte(22) * 256 + byte(23), 20);
}

TEST(Image, PngIsReadBackByAnotherProgramPixelForPixel) {
  if (!has_program("ffmpeg")) GTEST_SKIP() << "no ffmpeg program";
  const TestFolder folder("png-pixels");
  const Image image = gradient(33, 19);
  ASSERT_TRUE(write_png(folder / "a.png", image));
  const std::string raw =
      output_of("ffmpeg -v error -i '" + (folder / "a.png").string() + "' -f rawvideo -pix_fmt rgb24 -");
  ASSERT_EQ(raw.size(), 33U * 19 * 3);
  const std::vector<std::uint8_t> rgb(raw.begin(), raw.end());
  EXPECT_EQ(Image::from_rgb(rgb, 33, 19), image);
}

TEST(Image, PngThatCannotBeWrittenNamesTheFileAndLeavesNothing) {
  const TestFolder folder("png-fails");
  const auto missing = write_png(folder / "nowhere/a.png", gradient(4, 4));
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("nowhere/a.png"), std::string::npos);
  EXPECT_FALSE(write_png(folder / "b.png", Image()));
  EXPECT_TRUE(folder.empty());
}

}  // namespace
}  // namespace wisp::image_test
