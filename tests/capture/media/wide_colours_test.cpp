// Films in the colours of BT.2020 and of high dynamic range, made of a plain one by FFmpeg's program.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "capture/support/clip_files.hpp"
#include "wisp/capture/media/video.hpp"

namespace wisp::wide_colours_test {
namespace {

using support::ScratchFolder;

class WideColours : public testing::Test {
 protected:
  // Makes plain.mkv, of greys and colours, and wide.mkv of it by a filter.
  void make(const std::string& filter, const std::string& colours = "") {
    const std::string tags = "-color_primaries bt709 -color_trc bt709 -colorspace bt709";
    const std::string begin = "cd '" + folder_.path().string() + "' && ffmpeg -v error -y ";
    const std::string plain = begin +
                              "-f lavfi -i smptebars=160x120:rate=25:duration=1,scale=out_color_matrix=bt709,"
                              "format=yuv444p" +
                              colours + " " + tags + " -c:v ffv1 plain.mkv 2>&1";
    const std::string wide = begin + "-i plain.mkv -vf " + filter + " -c:v ffv1 -level 3 wide.mkv 2>&1";
    ASSERT_EQ(std::system(plain.c_str()), 0) << "this test needs ffmpeg";
    ASSERT_EQ(std::system(wide.c_str()), 0) << "this test needs ffmpeg with zscale, as script/bootstrap installs it";
  }

  RgbImage picture(const std::string& name) const {
    auto reader = VideoReader::open(folder_ / name);
    EXPECT_TRUE(reader) << reader.error().message;
    const auto frame = reader->next();
    EXPECT_TRUE(frame && *frame);
    const Picture& seen = (*frame)->picture;
    brightest_ = 0;
    std::vector<std::uint8_t> luma(static_cast<std::size_t>(seen.width) * seen.height);
    extract_channel(seen, PixelChannel::kLuma, seen.frame(), luma.data());
    for (const auto value : luma) brightest_ = std::max(brightest_, brightness(seen, PixelChannel::kLuma, value));
    return reader->rgb();
  }

  // Largest mean error of a colour channel over the picture, and the largest of the brightest point, levels.
  void expect_alike(double tolerance) {
    const RgbImage plain = picture("plain.mkv");
    const double brightest = brightest_;
    const RgbImage wide = picture("wide.mkv");
    ASSERT_EQ(plain.pixels.size(), wide.pixels.size());
    std::array<double, 3> error{};
    for (std::size_t k = 0; k < plain.pixels.size(); ++k)
      error[k % 3] += 3 * std::abs(plain.pixels[k] - wide.pixels[k]) / static_cast<double>(plain.pixels.size());
    for (const double one : error) EXPECT_LT(one, tolerance);
    EXPECT_NEAR(brightest, brightest_, 2 * tolerance);
  }

  ScratchFolder folder_{"wide"};
  mutable double brightest_ = 0;
};

TEST_F(WideColours, OfBt2020AreThoseOfThePlainFilm) {
  make("colorspace=all=bt2020:trc=bt2020-10:iall=bt709:format=yuv444p10");
  expect_alike(2);
}

// These filters convert primaries in the light that a screen emits, not in that on a camera: alike in pale colours. Of
// HLG they take a screen of gamma 2.4 and a system gamma of 1.2: a square root, up to 6 levels beside BT.709's curve.
constexpr const char* kPale = ",lutyuv=y=80+val/2:u=96+val/4:v=96+val/4";

TEST_F(WideColours, OfHybridLogGammaAreThoseOfThePlainFilm) {
  make("zscale=m=bt2020nc:p=bt2020:t=arib-std-b67:npl=203,format=yuv444p10", kPale);
  expect_alike(6);
}

TEST_F(WideColours, OfPerceptualQuantisationAreThoseOfThePlainFilm) {
  make("zscale=m=bt2020nc:p=bt2020:t=smpte2084:npl=203,format=yuv444p10", kPale);
  expect_alike(4);
}

}  // namespace
}  // namespace wisp::wide_colours_test
