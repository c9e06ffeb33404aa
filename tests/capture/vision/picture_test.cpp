#include "wisp/capture/vision/picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace wisp::picture_test {
namespace {

// A 4:2:0 picture of random luma and colours, as a decoder lays it out.
struct RandomYuv {
  static constexpr int kWidth = 38, kHeight = 22, kChromaWidth = 19, kChromaHeight = 11;
  std::vector<std::uint8_t> luma, cb, cr, interleaved;
  Picture picture;

  RandomYuv() : luma(kWidth * kHeight), cb(kChromaWidth * kChromaHeight), cr(cb.size()), interleaved(2 * cb.size()) {
    std::mt19937 random(7);
    const auto byte = [&] { return static_cast<std::uint8_t>(random() & 255); };
    std::generate(luma.begin(), luma.end(), byte);
    std::generate(cb.begin(), cb.end(), byte);
    std::generate(cr.begin(), cr.end(), byte);
    for (std::size_t k = 0; k < cb.size(); ++k) {
      interleaved[2 * k] = cb[k];
      interleaved[2 * k + 1] = cr[k];
    }
    picture.layout = PictureLayout::kYuv;
    picture.width = kWidth;
    picture.height = kHeight;
    picture.planes = {PicturePlane{luma.data(), kWidth, 1}, PicturePlane{cb.data(), kChromaWidth, 1},
                      PicturePlane{cr.data(), kChromaWidth, 1}};
    picture.chroma_shift_x = picture.chroma_shift_y = 1;
    picture.full_range = false;
  }

  // The defining formula of BT.601 or BT.709, in doubles.
  double reference(PixelChannel channel, int x, int y) const {
    const double kr = picture.bt709 ? 0.2126 : 0.299, kb = picture.bt709 ? 0.0722 : 0.114, kg = 1 - kr - kb;
    const std::size_t at = static_cast<std::size_t>(y / 2) * kChromaWidth + x / 2;
    const double l = picture.full_range ? luma[y * kWidth + x] : (luma[y * kWidth + x] - 16) * 255.0 / 219;
    const double scale = picture.full_range ? 1 : 255.0 / 224;
    const double blue = l + 2 * (1 - kb) * scale * (cb[at] - 128), red = l + 2 * (1 - kr) * scale * (cr[at] - 128);
    const double green = (l - kr * red - kb * blue) / kg;
    const double value = channel == PixelChannel::kRed ? red : channel == PixelChannel::kBlue ? blue : green;
    return std::clamp(value, 0.0, 255.0);
  }
};

// 6 fractional bits in the factors: at most 255 / 128 grey levels from the luma factor, as much from a colour's, and
// half a level of rounding.
constexpr double kConversionError = 3.5;

double worst_error(const RandomYuv& yuv, PixelChannel channel, const Region& region) {
  std::vector<std::uint8_t> out(static_cast<std::size_t>(region.width) * region.height);
  extract_channel(yuv.picture, channel, region, out.data());
  double worst = 0;
  std::size_t k = 0;
  for (int y = region.y; y < region.bottom(); ++y) {
    for (int x = region.x; x < region.right(); ++x) {
      worst = std::max(worst, std::abs(out[k++] - yuv.reference(channel, x, y)));
    }
  }
  return worst;
}

TEST(Picture, ColoursOfVideoFollowTheStandardsFormula) {
  for (const bool bt709 : {false, true}) {
    for (const bool full : {false, true}) {
      RandomYuv yuv;
      yuv.picture.bt709 = bt709;
      yuv.picture.full_range = full;
      for (const PixelChannel channel : {PixelChannel::kRed, PixelChannel::kGreen, PixelChannel::kBlue}) {
        EXPECT_LT(worst_error(yuv, channel, yuv.picture.frame()), kConversionError) << channel_name(channel);
      }
    }
  }
}

TEST(Picture, ARegionMayBeginAtAnyPixel) {
  const RandomYuv yuv;
  for (const int x : {0, 1, 2, 3}) {
    EXPECT_LT(worst_error(yuv, PixelChannel::kRed, {x, 5, 17, 4}), kConversionError) << x;
  }
}

TEST(Picture, InterleavedColourPlanesGiveTheSame) {
  const RandomYuv yuv;
  Picture nv12 = yuv.picture;
  nv12.planes[1] = {yuv.interleaved.data(), 2 * RandomYuv::kChromaWidth, 2};
  nv12.planes[2] = {yuv.interleaved.data() + 1, 2 * RandomYuv::kChromaWidth, 2};
  const Region region{3, 4, 20, 10};
  std::vector<std::uint8_t> planar(200), packed(200);
  extract_channel(yuv.picture, PixelChannel::kGreen, region, planar.data());
  extract_channel(nv12, PixelChannel::kGreen, region, packed.data());
  EXPECT_EQ(planar, packed);
}

TEST(Picture, SamplingTakesTheSamePixels) {
  const RandomYuv yuv;
  const Region region{1, 2, 30, 18};
  std::vector<std::uint8_t> whole(540), some(60);
  for (const PixelChannel channel : {PixelChannel::kLuma, PixelChannel::kBlue}) {
    extract_channel(yuv.picture, channel, region, whole.data());
    sample_channel(yuv.picture, channel, region, 3, some.data());
    for (int y = 0; y < 6; ++y) {
      for (int x = 0; x < 10; ++x) EXPECT_EQ(some[y * 10 + x], whole[3 * y * 30 + 3 * x]);
    }
  }
}

TEST(Picture, LumaOfVideoIsNotCopied) {
  const RandomYuv yuv;
  EXPECT_EQ(plane_in_place(yuv.picture, PixelChannel::kLuma).pixels, yuv.luma.data());
  EXPECT_EQ(plane_in_place(yuv.picture, PixelChannel::kRed).pixels, nullptr);
}

TEST(Picture, PackedRgbGivesItsChannelsAndTheirLuma) {
  const std::vector<std::uint8_t> pixels{255, 0, 0, 0, 255, 0, 0, 0, 255, 200, 200, 200};
  const Picture picture = rgb_picture({pixels.data(), 2, 2, 6}, 3);
  std::vector<std::uint8_t> out(4);
  extract_channel(picture, PixelChannel::kGreen, picture.frame(), out.data());
  EXPECT_EQ(out, (std::vector<std::uint8_t>{0, 255, 0, 200}));
  extract_channel(picture, PixelChannel::kLuma, picture.frame(), out.data());
  EXPECT_EQ(out, (std::vector<std::uint8_t>{76, 150, 29, 200}));
}

TEST(Picture, AGreyPictureHasNoColours) {
  const std::uint8_t pixel = 9;
  const Picture picture = grey_picture({&pixel, 1, 1, 1});
  EXPECT_TRUE(has_channel(picture, PixelChannel::kLuma));
  EXPECT_FALSE(has_channel(picture, PixelChannel::kRed));
}

TEST(Picture, AnyChannelOfAGreyPictureIsItsLuma) {
  const std::vector<std::uint8_t> pixels{9, 80, 160, 235};
  const Picture picture = grey_picture({pixels.data(), 2, 2, 2});
  std::vector<std::uint8_t> whole(4), some(1);
  for (const PixelChannel channel : {PixelChannel::kRed, PixelChannel::kGreen, PixelChannel::kBlue}) {
    extract_channel(picture, channel, picture.frame(), whole.data());
    sample_channel(picture, channel, picture.frame(), 2, some.data());
    EXPECT_EQ(whole, pixels);
    EXPECT_EQ(some.front(), 9);
  }
}

TEST(Picture, BrightnessIsFullRangeWhateverIsStored) {
  const RandomYuv yuv;
  EXPECT_DOUBLE_EQ(brightness(yuv.picture, PixelChannel::kLuma, 16), 0);
  EXPECT_DOUBLE_EQ(brightness(yuv.picture, PixelChannel::kLuma, 235), 255);
  EXPECT_DOUBLE_EQ(brightness(yuv.picture, PixelChannel::kRed, 100), 100);
}

TEST(OwnedPicture, KeepsThePictureWhenTheOriginalIsGone) {
  auto yuv = std::make_unique<RandomYuv>();
  std::vector<std::uint8_t> before(RandomYuv::kWidth * RandomYuv::kHeight), after(before.size());
  extract_channel(yuv->picture, PixelChannel::kRed, yuv->picture.frame(), before.data());
  OwnedPicture kept(yuv->picture);
  yuv.reset();
  const OwnedPicture moved = std::move(kept);
  extract_channel(moved.picture(), PixelChannel::kRed, moved.picture().frame(), after.data());
  EXPECT_EQ(before, after);
}

}  // namespace
}  // namespace wisp::picture_test
