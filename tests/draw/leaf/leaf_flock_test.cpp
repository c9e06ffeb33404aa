#include "wisp/draw/leaf_flock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "draw/draw_test_pictures.hpp"
#include "draw/textured.hpp"
#include "wisp/draw/overlay.hpp"

namespace wisp::leaf_flock_test {
namespace {

constexpr int kWidth = 240;
constexpr int kHeight = 200;

LeafCamera camera() { return leaf_camera_from_side(0.3F); }

Image flock_picture(std::span<const FlockLeaf> leaves) {
  LeafFlock flock(kWidth, kHeight, camera());
  Image image;
  flock.draw(image, leaves);
  return image;
}

FlockLeaf leaf_at(float height, std::array<float, 4> attitude = {0.6F, 0.7F, 0.1F, 0.2F}) {
  return {.pose = {{0, 0, height}, attitude}};
}

// Pixels that differ clearly from the empty room: the leaf itself, not its soft shadow.
std::vector<bool> covered(const Image& image, const Image& room) {
  std::vector<bool> mask;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x)
      mask.push_back(std::abs(brightness_at(image, x, y) - brightness_at(room, x, y)) > 50);
  }
  return mask;
}

double darkness(const Image& image, const Image& room) {
  double sum = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x)
      sum += static_cast<double>(brightness_at(room, x, y)) - static_cast<double>(brightness_at(image, x, y));
  }
  return sum;
}

TEST(LeafFlock, LaysALeafWhereDrawLeavesDoes) {
  const Image room = draw_leaf_room(kWidth, kHeight, camera());
  for (const std::array<float, 4> attitude :
       {std::array<float, 4>{0.6F, 0.7F, 0.1F, 0.2F}, std::array<float, 4>{0.9F, -0.5F, 0.3F, 0.6F}}) {
    const FlockLeaf leaf = leaf_at(0.15F, attitude);
    Image slow = room;
    const DrawnLeaf drawn{.pose = leaf.pose};
    draw_leaves(slow, {&drawn, 1}, camera());
    const auto a = covered(flock_picture({&leaf, 1}), room), b = covered(slow, room);
    int both = 0, either = 0;
    for (std::size_t k = 0; k < a.size(); ++k) both += a[k] && b[k], either += a[k] || b[k];
    EXPECT_GT(either, 300);
    EXPECT_GT(both, 0.72 * either);
  }
}

TEST(LeafFlock, DrawsTheNearerLeafOverTheFartherWhateverTheirOrder) {
  FlockLeaf near = leaf_at(0.15F), far = leaf_at(0.15F);
  near.pose.position[1] = -0.1F;
  far.pose.position[1] = 0.1F;
  far.look = 1;
  EXPECT_EQ(flock_picture(std::array{near, far}), flock_picture(std::array{far, near}));
}

TEST(LeafFlock, CastsShadowsThatFadeWithHeight) {
  const Image room = draw_leaf_room(kWidth, kHeight, camera());
  const auto darkest = [&](float height) {
    const FlockLeaf leaf = leaf_at(height, {1, 0, 0, 0});
    const Image image = flock_picture({&leaf, 1});
    float most = 0;
    // The floor below and beside the leaf.
    for (int y = 3 * kHeight / 4; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) most = std::max(most, brightness_at(room, x, y) - brightness_at(image, x, y));
    }
    return most;
  };
  EXPECT_GT(darkest(0.10F), darkest(0.20F) + 5);
  EXPECT_GT(darkest(0.20F), 3);
}

TEST(LeafFlock, LeavesOutWhatCannotBeSeen) {
  const Image room = draw_leaf_room(kWidth, kHeight, camera());
  FlockLeaf lost = leaf_at(std::numeric_limits<float>::quiet_NaN()), clear = leaf_at(0.15F), behind = leaf_at(0.1F);
  clear.opacity = 0;
  behind.pose.position[1] = -5;
  EXPECT_EQ(flock_picture(std::array{lost, clear, behind}), room);
  EXPECT_GT(darkness(flock_picture(std::array{leaf_at(0.15F)}), room), 1000);
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

TEST(Note, IsAPlateOfLinesInItsCorner) {
  const Image blank(400, 300, {90, 90, 90});
  Image image = blank, faint = blank;
  const std::array<std::string, 2> lines{"key\twhat it does", "and more"};
  draw_note(image, lines, Corner::kBottomRight, 14);
  draw_note(faint, lines, Corner::kBottomRight, 14, 0.3F);
  EXPECT_EQ(crop(image, {0, 0, 200, 300}), crop(blank, {0, 0, 200, 300}));
  const PixelBox corner{200, 230, 200, 70};
  EXPECT_FALSE(crop(image, corner) == crop(blank, corner));
  EXPECT_LT(darkness(faint, blank), darkness(image, blank));
  draw_note(image = blank, lines, Corner::kTopLeft, 14, 0);
  EXPECT_EQ(image, blank);
}

}  // namespace
}  // namespace wisp::leaf_flock_test
