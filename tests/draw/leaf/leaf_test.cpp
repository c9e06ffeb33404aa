// Leaves over a floor, from poses.

#include "wisp/draw/leaf.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wisp::leaf_test {
namespace {

constexpr int kWidth = 240, kHeight = 160;

// Looking straight down from high above: a metre of floor fills the picture's height.
const LeafCamera kAbove = leaf_camera_from_above({0, 0, 0}, 0.5F);

DrawnLeaf leaf_at(float x, float y, float z, std::array<float, 4> attitude = {1, 0, 0, 0}) {
  DrawnLeaf leaf;
  leaf.pose = {{x, y, z}, attitude};
  leaf.style.scale = 2;
  return leaf;
}

Image empty_room() { return draw_leaf_room(kWidth, kHeight, kAbove); }

Image drawn(std::span<const DrawnLeaf> leaves, const LeafCamera& camera = kAbove) {
  Image image = draw_leaf_room(kWidth, kHeight, camera);
  draw_leaves(image, leaves, camera);
  return image;
}

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

TEST(DrawLeaf, IsWhereItsPoseSays) {
  const DrawnLeaf leaf = leaf_at(0.1F, -0.05F, 0.02F);
  const Extent extent = leaf_in(drawn({&leaf, 1}));
  // 320 pixels a metre; y is up in the world and down in the picture. The stalk pulls the middle a little.
  EXPECT_NEAR(extent.middle_x, kWidth / 2 + 32, 3);
  EXPECT_NEAR(extent.middle_y, kHeight / 2 + 16, 2);
  // About two thirds of an ellipse of 14.6 × 9.8 cm.
  EXPECT_GT(extent.pixels, 600);
  EXPECT_LT(extent.pixels, 1150);
}

TEST(DrawLeaf, ShowsItsPaleSideWhenItIsOver) {
  const DrawnLeaf up = leaf_at(0, 0, 0.02F), over = leaf_at(0, 0, 0.02F, {0, 1, 0, 0});
  const auto brightness = [](const Image& image) {
    int sum = 0;
    for (int y = -6; y <= 6; y += 3) sum += image.at(kWidth / 2 + 4, kHeight / 2 + y).green;
    return sum;
  };
  EXPECT_GT(brightness(drawn({&over, 1})), brightness(drawn({&up, 1})) + 100);
}

TEST(DrawLeaf, IsALineFromItsEdge) {
  DrawnLeaf flat = leaf_at(0, 0, 0.1F), on_edge = leaf_at(0, 0, 0.1F, {std::sqrt(0.5F), std::sqrt(0.5F), 0, 0});
  flat.style.curl = on_edge.style.curl = 0;
  EXPECT_LT(leaf_in(drawn({&on_edge, 1})).pixels, leaf_in(drawn({&flat, 1})).pixels / 10);
}

TEST(DrawLeaf, CastsAShadowAwayFromTheLampThatSoftensWithHeight) {
  DrawnLeaf low = leaf_at(0, 0, 0.1F), high = leaf_at(0, 0, 0.3F);
  low.style.scale = high.style.scale = 1;
  const Extent near_floor = shadow_in(drawn({&low, 1})), far_up = shadow_in(drawn({&high, 1}));
  // The lamp is at the left and in front (−x, −y): the shadow goes to the right and up in the picture.
  EXPECT_GT(near_floor.middle_x, kWidth / 2);
  EXPECT_GT(far_up.middle_x, near_floor.middle_x + 8);
  EXPECT_LT(far_up.middle_y, near_floor.middle_y - 8);
  const auto depth = [](const DrawnLeaf& leaf, const Extent& shadow) {
    const int x = static_cast<int>(shadow.middle_x), y = static_cast<int>(shadow.middle_y);
    return empty_room().at(x, y).green - drawn({&leaf, 1}).at(x, y).green;
  };
  EXPECT_GT(depth(low, near_floor), depth(high, far_up) + 10);
}

TEST(DrawLeaf, HidesWhatIsBehindItWhateverTheOrder) {
  DrawnLeaf front = leaf_at(0, 0, 0.3F), back = leaf_at(0, 0, 0.05F);
  back.style.upper = back.style.margin = back.style.vein = {20, 60, 200};
  const std::array<DrawnLeaf, 2> one{front, back}, other{back, front};
  EXPECT_EQ(drawn(one), drawn(other));
  EXPECT_GT(redness(drawn(one).at(kWidth / 2 + 3, kHeight / 2 + 4)), 40);
}

TEST(DrawLeaf, LeavesATrail) {
  DrawnLeaf leaf = leaf_at(0.2F, 0.1F, 0.1F);
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

TEST(DrawLeaf, FadesWithItsShadow) {
  DrawnLeaf leaf = leaf_at(0, 0, 0.1F);
  leaf.opacity = 0;
  EXPECT_EQ(drawn({&leaf, 1}), empty_room());
}

TEST(DrawLeaf, DrawsTheSameBytesAgain) {
  const DrawnLeaf leaf = leaf_at(0.03F, 0.02F, 0.4F, {0.7F, 0.5F, -0.3F, 0.4F});
  const LeafCamera side = leaf_camera_from_side(0.9F);
  EXPECT_EQ(drawn({&leaf, 1}, side), drawn({&leaf, 1}, side));
}

TEST(DrawLeaf, LeavesOutWhatHasNoPlace) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), far = std::numeric_limits<float>::infinity();
  const std::array<DrawnLeaf, 4> nowhere{leaf_at(nan, 0, 0), leaf_at(0, far, 0), leaf_at(0, 0, 0.1F, {0, 0, 0, 0}),
                                         leaf_at(0, 0, 1000)};
  EXPECT_EQ(drawn(nowhere), empty_room());
}

TEST(DrawLeaf, FillsThePictureFromNearBy) {
  const DrawnLeaf leaf = leaf_at(0, 0, 0.1F);
  const LeafCamera near_by{{0.01F, 0, 0.2F}, {0.01F, 0, 0.1F}, 0.02F};
  EXPECT_EQ(leaf_in(drawn({&leaf, 1}, near_by)).pixels, kWidth * kHeight);
}

TEST(DrawLeaf, HoldsAbsurdStylesAndCameras) {
  DrawnLeaf leaf = leaf_at(0, 0, 0.1F);
  leaf.style.length = 1e9F, leaf.style.scale = -4, leaf.style.curl = 1e6F, leaf.opacity = 50;
  drawn({&leaf, 1});
  drawn({&leaf, 1}, {{0, 0, 0}, {0, 0, 0}, 0});
  drawn({&leaf, 1}, {{0, 0, 0.1F}, {0, 0, 0.1F}, 1e9F});
  LeafRoom room;
  room.lamp = {1, 0, -1};
  Image image = draw_leaf_room(16, 16, kAbove, room);
  draw_leaves(image, {&leaf, 1}, kAbove, room);
  EXPECT_EQ(image.width(), 16);
}

}  // namespace
}  // namespace wisp::leaf_test
