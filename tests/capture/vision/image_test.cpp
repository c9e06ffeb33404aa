#include "wisp/capture/vision/image.hpp"

#include <gtest/gtest.h>

namespace wisp::image_test {
namespace {

TEST(Region, IntersectionIsWhatBothShare) {
  EXPECT_EQ(intersection({0, 0, 10, 10}, {5, 6, 10, 10}), (Region{5, 6, 5, 4}));
  EXPECT_TRUE(intersection({0, 0, 5, 5}, {5, 0, 5, 5}).empty());
}

TEST(Region, EnclosingIgnoresAnEmptyOne) {
  EXPECT_EQ(enclosing({1, 2, 3, 4}, {}), (Region{1, 2, 3, 4}));
  EXPECT_EQ(enclosing({0, 0, 2, 2}, {5, 5, 1, 1}), (Region{0, 0, 6, 6}));
}

TEST(Region, GrowsOnEverySide) { EXPECT_EQ(grown({5, 6, 2, 3}, 2), (Region{3, 4, 6, 7})); }

TEST(ImageView, CropSharesThePixels) {
  const std::vector<std::uint8_t> pixels{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  const ImageView image{pixels.data(), 4, 3, 4};
  const ImageView part = crop(image, {1, 1, 2, 2});
  EXPECT_EQ(part.at(0, 0), 5);
  EXPECT_EQ(part.at(1, 1), 10);
}

TEST(PixelChannel, NamesGoBothWays) {
  for (const PixelChannel channel :
       {PixelChannel::kLuma, PixelChannel::kRed, PixelChannel::kGreen, PixelChannel::kBlue}) {
    EXPECT_EQ(channel_from_name(channel_name(channel)), channel);
  }
  EXPECT_FALSE(channel_from_name("purple"));
}

}  // namespace
}  // namespace wisp::image_test
