// Leaves over a floor, from poses.

#include "wisp/draw/leaf.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "draw/draw_test_pictures.hpp"
#include "draw/leaf/leaf_view.hpp"
#include "wisp/draw/overlay.hpp"

namespace wisp::leaf_test {
namespace {

constexpr int kWidth = 240, kHeight = 160;

// Looking straight down from high above: a metre of floor fills the picture's height.
const LeafCamera kAbove{.eye = {0, 0, 1.6F}, .target = {0, 0, 0}, .view_height = 0.5F};

FlockLeaf leaf_at(float x, float y, float z, std::array<float, 4> attitude = {1, 0, 0, 0}) {
  return {.pose = {{x, y, z}, attitude}, .size = 2};
}

Image drawn(std::span<const FlockLeaf> leaves, const LeafCamera& camera = kAbove, const LeafStyle& style = {}) {
  LeafFlock flock(kWidth, kHeight, camera, style);
  Image image;
  flock.draw(image, leaves);
  return image;
}

Image empty_room() { return drawn({}); }

// How far a pixel is from gray: leaves are red, the floor and shadows are not.
int redness(Colour colour) { return colour.red - colour.blue; }

struct Extent {
  int pixels = 0;
  double middle_x = 0, middle_y = 0;
};

template <class Chosen>
Extent extent_of(const Image& image, Chosen chosen) {
  Extent extent;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (!chosen(image.at(x, y), x, y)) continue;
      ++extent.pixels;
      extent.middle_x += x, extent.middle_y += y;
    }
  }
  extent.middle_x /= std::max(1, extent.pixels);
  extent.middle_y /= std::max(1, extent.pixels);
  return extent;
}

Extent leaf_in(const Image& image) {
  return extent_of(image, [](Colour c, int, int) { return redness(c) > 60; });
}

Extent shadow_in(const Image& image) {
  const Image empty = empty_room();
  return extent_of(image,
                   [&](Colour c, int x, int y) { return redness(c) < 40 && empty.at(x, y).green - c.green > 6; });
}

TEST(LeafFlock, IsWhereItsPoseSays) {
  const FlockLeaf leaf = leaf_at(0.1F, -0.05F, 0.02F);
  const Extent extent = leaf_in(drawn({&leaf, 1}));
  // 320 pixels a metre; y is up in the world and down in the picture. The stalk pulls the middle a little.
  EXPECT_NEAR(extent.middle_x, kWidth / 2 + 32, 3);
  EXPECT_NEAR(extent.middle_y, kHeight / 2 + 16, 2);
  // About two thirds of an ellipse of 14.6 × 9.8 cm.
  EXPECT_GT(extent.pixels, 600);
  EXPECT_LT(extent.pixels, 1150);
}

TEST(LeafFlock, ShowsItsDullSideWhenItIsOver) {
  const FlockLeaf up = leaf_at(0, 0, 0.02F), over = leaf_at(0, 0, 0.02F, {0, 1, 0, 0});
  const auto colour = [](const Image& image) {
    int sum = 0;
    for (int y = -6; y <= 6; y += 3) {
      const Colour at = image.at(kWidth / 2 + 4, kHeight / 2 + y);
      sum += at.red - at.green;
    }
    return sum;
  };
  EXPECT_LT(colour(drawn({&over, 1})), colour(drawn({&up, 1})) - 100);
}

TEST(LeafFlock, IsALineFromItsEdge) {
  const FlockLeaf flat = leaf_at(0, 0, 0.1F), on_edge = leaf_at(0, 0, 0.1F, {std::sqrt(0.5F), std::sqrt(0.5F), 0, 0});
  const LeafStyle style{.curl = 0};
  EXPECT_LT(leaf_in(drawn({&on_edge, 1}, kAbove, style)).pixels, leaf_in(drawn({&flat, 1}, kAbove, style)).pixels / 10);
}

TEST(LeafFlock, CastsAShadowAwayFromTheLampThatSoftensWithHeight) {
  FlockLeaf low = leaf_at(0, 0, 0.1F), high = leaf_at(0, 0, 0.3F);
  low.size = high.size = 1;
  const Extent near_floor = shadow_in(drawn({&low, 1})), far_up = shadow_in(drawn({&high, 1}));
  // The lamp is at the left and in front (−x, −y): the shadow goes to the right and up in the picture.
  EXPECT_GT(near_floor.middle_x, kWidth / 2);
  EXPECT_GT(far_up.middle_x, near_floor.middle_x + 8);
  EXPECT_LT(far_up.middle_y, near_floor.middle_y - 8);
  const auto depth = [](const FlockLeaf& leaf, const Extent& shadow) {
    const int x = static_cast<int>(shadow.middle_x), y = static_cast<int>(shadow.middle_y);
    return empty_room().at(x, y).green - drawn({&leaf, 1}).at(x, y).green;
  };
  EXPECT_GT(depth(low, near_floor), depth(high, far_up) + 10);
}

TEST(LeafFlock, HidesWhatIsBehindItWhateverTheOrder) {
  const LeafStyle blue{.upper = {20, 60, 200}, .margin = {20, 60, 200}, .vein = {20, 60, 200}};
  FlockLeaf front = leaf_at(0, 0, 0.3F), back = leaf_at(0, 0, 0.05F);
  front.look = 1;
  const std::array<FlockLeaf, 2> one{front, back}, other{back, front};
  EXPECT_EQ(drawn(one, kAbove, blue), drawn(other, kAbove, blue));
  EXPECT_GT(redness(drawn(one, kAbove, blue).at(kWidth / 2 + 3, kHeight / 2 + 4)), 40);
}

TEST(LeafFlock, LeavesATrail) {
  FlockLeaf leaf = leaf_at(0.2F, 0.1F, 0.1F);
  std::vector<LeafPose> way;
  for (int k = 0; k < 20; ++k) way.push_back({{-0.25F + 0.02F * static_cast<float>(k), -0.15F, 0.1F}, {1, 0, 0, 0}});
  const Image without = drawn({&leaf, 1});
  leaf.trail = way;
  const Image with = drawn({&leaf, 1});
  int changed = 0;
  for (std::size_t k = 0; k < with.pixels().size(); ++k) changed += with.pixels()[k] != without.pixels()[k];
  EXPECT_GT(changed, 60);
  EXPECT_LT(changed, 800);
}

TEST(LeafFlock, FadesWithItsShadow) {
  FlockLeaf leaf = leaf_at(0, 0, 0.1F);
  leaf.opacity = 0;
  EXPECT_EQ(drawn({&leaf, 1}), empty_room());
}

TEST(LeafFlock, DrawsTheSameBytesAgain) {
  const FlockLeaf leaf = leaf_at(0.03F, 0.02F, 0.4F, {0.7F, 0.5F, -0.3F, 0.4F});
  const LeafCamera side = leaf_camera_from_side(0.9F);
  EXPECT_EQ(drawn({&leaf, 1}, side), drawn({&leaf, 1}, side));
}

TEST(LeafFlock, LeavesOutWhatHasNoPlace) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), far = std::numeric_limits<float>::infinity();
  const std::array<FlockLeaf, 4> nowhere{leaf_at(nan, 0, 0), leaf_at(0, far, 0), leaf_at(0, 0, 0.1F, {0, 0, 0, 0}),
                                         leaf_at(0, 0, 1000)};
  EXPECT_EQ(drawn(nowhere), empty_room());
}

TEST(LeafFlock, FillsThePictureFromNearBy) {
  const FlockLeaf leaf = leaf_at(0, 0, 0.1F);
  const LeafCamera near_by{{0.01F, 0, 0.2F}, {0.01F, 0, 0.1F}, 0.02F};
  EXPECT_EQ(leaf_in(drawn({&leaf, 1}, near_by)).pixels, kWidth * kHeight);
}

TEST(LeafFlock, HoldsAbsurdStylesAndCameras) {
  FlockLeaf leaf = leaf_at(0, 0, 0.1F);
  leaf.size = -4, leaf.opacity = 50;
  drawn({&leaf, 1}, kAbove, {.length = 1e9F, .curl = 1e6F});
  drawn({&leaf, 1}, {{0, 0, 0}, {0, 0, 0}, 0});
  drawn({&leaf, 1}, {{0, 0, 0.1F}, {0, 0, 0.1F}, 1e9F});
  LeafFlock unlit(16, 16, kAbove, {}, {.lamp = {1, 0, -1}});
  Image image;
  unlit.draw(image, {&leaf, 1});
  EXPECT_EQ(image.width(), 16);
}

TEST(TexturedTriangles, ThatShareASideCoverEachPixelOnce) {
  const drawing::Texture::Level gray{1, 1, {0xFF808080U}};
  Image image(40, 40);
  // The shared sides are diagonals through the middles of pixels.
  const drawing::TexturedCorner a{4.5F, 4.5F}, b{32.5F, 4.5F}, c{32.5F, 32.5F}, d{4.5F, 32.5F}, middle{18.5F, 18.5F};
  for (const auto& [p, q] : {std::pair{a, b}, std::pair{b, c}, std::pair{c, d}, std::pair{d, a}})
    drawing::draw_textured(image, p, q, middle, gray, 0.5F);
  int laid = 0;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      const int red = image.at(x, y).red;
      EXPECT_TRUE(red == 0 || red == image.at(19, 12).red) << x << " " << y << ": " << red;
      laid += red != 0;
    }
  }
  EXPECT_EQ(laid, 28 * 28);
}

double changed(const Image& image, const Image& blank) {
  double sum = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) sum += std::abs(brightness_at(image, x, y) - brightness_at(blank, x, y));
  }
  return sum;
}

TEST(Note, IsAPlateOfLinesInItsCorner) {
  const Image blank(400, 300, {90, 90, 90});
  Image image = blank, faint = blank;
  const std::array<std::string, 2> lines{"key\twhat it does", "and more"};
  draw_note(image, lines, Corner::kBottomRight, 14);
  draw_note(faint, lines, Corner::kBottomRight, 14, 0.3F);
  EXPECT_EQ(crop(image, {0, 0, 200, 300}), crop(blank, {0, 0, 200, 300}));
  const PixelBox corner{200, 230, 200, 70};
  EXPECT_FALSE(crop(image, corner) == crop(blank, corner));
  EXPECT_LT(changed(faint, blank), changed(image, blank));
  draw_note(image = blank, lines, Corner::kTopLeft, 14, 0);
  EXPECT_EQ(image, blank);
}

}  // namespace
}  // namespace wisp::leaf_test
