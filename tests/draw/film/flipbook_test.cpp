#include "wisp/draw/film_strip.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "draw/draw_test_pictures.hpp"
#include "folder_test.hpp"

namespace wisp::flipbook_test {
namespace {

namespace fs = std::filesystem;

class FlipbookTest : public FolderTest {
 protected:
  FlipbookTest() {
    for (int k = 0; k < 5; ++k) {
      // Half transparent, so that straight and premultiplied differ.
      book_.frames.emplace_back(16, 24, Colour{static_cast<std::uint8_t>(40 * k), 200, 10, 128});
    }
    book_.loop = true;
    book_.pivot = {8, 24};
  }

  // All frames as another program reads them, which script/bootstrap installs: RGBA bytes.
  std::string read_by_ffmpeg(const std::string& name, const std::string& decoder = "") const {
    return output_of("ffmpeg -v error " + decoder + " -i '" + (folder_ / name).string() +
                     "' -f rawvideo -pix_fmt rgba -");
  }

  Flipbook book_;
};

int byte(const std::string& bytes, std::size_t at) { return static_cast<unsigned char>(bytes.at(at)); }

TEST_F(FlipbookTest, AnAtlasHoldsThePremultipliedNumbersOfEveryFrameAtItsPlace) {
  ASSERT_TRUE(write_atlas(folder_ / "a.png", book_));
  std::ifstream stream(folder_ / "a.atlas.json");
  std::stringstream text;
  text << stream.rdbuf();
  const std::string json = text.str();
  EXPECT_NE(json.find("\"premultiplied\":true"), std::string::npos);
  EXPECT_NE(json.find("\"columns\":3,\"rows\":2"), std::string::npos) << json;
  EXPECT_NE(json.find("{\"x\":16,\"y\":24,\"w\":16,\"h\":24}"), std::string::npos) << "the fifth frame";
  const std::string pixels = read_by_ffmpeg("a.png");
  ASSERT_EQ(pixels.size(), 48u * 48 * 4);
  const std::size_t fifth = (24 * 48 + 16) * 4;
  EXPECT_EQ(byte(pixels, fifth), 80);  // 160 · 128/255
  EXPECT_EQ(byte(pixels, fifth + 1), 100);
  EXPECT_EQ(byte(pixels, fifth + 3), 128);
}

TEST_F(FlipbookTest, AnAtlasOfAnyNameIsJson) {
  ASSERT_TRUE(write_atlas(folder_ / "a\"b.png", book_));
  std::ifstream stream(folder_ / "a\"b.atlas.json");
  std::stringstream text;
  text << stream.rdbuf();
  EXPECT_NE(text.str().find("\"image\":\"a\\\"b.png\""), std::string::npos) << text.str();
}

TEST_F(FlipbookTest, AnApngHoldsStraightColoursAndEveryFrame) {
  ASSERT_TRUE(write_animation(folder_ / "a.apng", book_));
  const std::string pixels = read_by_ffmpeg("a.apng");
  ASSERT_EQ(pixels.size(), 5u * 16 * 24 * 4);
  for (std::size_t frame = 0; frame < 5; ++frame) {
    EXPECT_NEAR(byte(pixels, frame * 16 * 24 * 4), 40 * static_cast<int>(frame), 1);
    EXPECT_EQ(byte(pixels, frame * 16 * 24 * 4 + 3), 128);
  }
}

TEST_F(FlipbookTest, AWebmHasOpacity) {
  ASSERT_TRUE(write_animation(folder_ / "a.webm", book_));
  // FFmpeg's own decoder of VP9 leaves opacity out.
  const std::string pixels = read_by_ffmpeg("a.webm", "-c:v libvpx-vp9");
  ASSERT_EQ(pixels.size(), 5u * 16 * 24 * 4);
  EXPECT_NEAR(byte(pixels, 3), 128, 3);
  EXPECT_NEAR(byte(pixels, 1), 200, 6);
}

TEST_F(FlipbookTest, AnAnimationOfFramesThatAreDrawnOneByOneIsTheSame) {
  std::vector<std::size_t> drawn;
  const auto draw = [&](std::size_t k) {
    drawn.push_back(k);
    return book_.frames[k];
  };
  const Flipbook rate{.loop = true};
  ASSERT_TRUE(write_animation(folder_ / "a.apng", book_));
  ASSERT_TRUE(write_animation(folder_ / "b.apng", rate, 5, draw));
  EXPECT_EQ(read_by_ffmpeg("b.apng"), read_by_ffmpeg("a.apng"));
  EXPECT_EQ(drawn, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  EXPECT_NE(write_animation(folder_ / "b.apng", rate, 0, draw).error().message.find("no frames"), std::string::npos);
}

TEST_F(FlipbookTest, LightOverBlackIsWhatItWas) {
  Image image(1, 1, {30, 90, 60, 255});
  make_light(image);
  EXPECT_EQ(image.pixels()[0], 0x5a1e5a3cu);
}

TEST_F(FlipbookTest, WhatCannotBeWrittenIsSaid) {
  EXPECT_NE(write_atlas(folder_ / "a.png", {}).error().message.find("no frames"), std::string::npos);
  EXPECT_NE(write_animation(folder_ / "a.gif", book_).error().message.find(".apng or .webm"), std::string::npos);
  Flipbook large{.frames = std::vector<Image>(9, Image(30000, 1))};
  EXPECT_NE(write_atlas(folder_ / "a.png", large).error().message.find("at most 16384"), std::string::npos);
  book_.frames.emplace_back(3, 3);
  EXPECT_NE(write_atlas(folder_ / "a.png", book_).error().message.find("several sizes"), std::string::npos);
}

}  // namespace
}  // namespace wisp::flipbook_test
