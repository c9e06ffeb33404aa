#include "wisp/draw/overlay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "draw/draw_test_pictures.hpp"

namespace wisp::overlay_test {
namespace {

constexpr Colour kGray{120, 120, 120, 255};
const std::vector<Point> kSquare{{20, 20}, {80, 20}, {80, 80}, {20, 80}};

int changed_pixels(const Image& image, PixelBox box) {
  int changed = 0;
  for (int y = box.y; y < box.y + box.height; ++y) {
    for (int x = box.x; x < box.x + box.width; ++x) changed += image.at(x, y) != kGray ? 1 : 0;
  }
  return changed;
}

TEST(Overlay, ALineHasItsColourOnThePathAndADarkCasingBeside) {
  Image image(100, 100, kGray);
  draw_outline(image, kSquare, {.colour = {255, 0, 0}, .width = 3, .casing = 2});
  EXPECT_EQ(image.at(50, 20), (Colour{255, 0, 0, 255}));
  EXPECT_LT(brightness_at(image, 50, 22), 60);
  EXPECT_EQ(image.at(50, 30), kGray);
}

TEST(Overlay, AClosedLineReturnsToItsBeginning) {
  Image open(100, 100, kGray);
  Image closed(100, 100, kGray);
  draw_outline(open, kSquare, {.colour = {255, 0, 0}, .width = 3, .closed = false});
  draw_outline(closed, kSquare, {.colour = {255, 0, 0}, .width = 3});
  EXPECT_EQ(open.at(20, 50), kGray);
  EXPECT_EQ(closed.at(20, 50), (Colour{255, 0, 0, 255}));
}

TEST(Overlay, APointThatIsNotFiniteBreaksTheLine) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Image image(100, 100, kGray);
  draw_outline(image, std::vector<Point>{{10, 50}, {30, 50}, {nan, 50}, {70, 50}, {90, 50}}, {.width = 3});
  EXPECT_NE(image.at(20, 50), kGray);
  EXPECT_NE(image.at(80, 50), kGray);
  EXPECT_EQ(image.at(50, 50), kGray);
}

TEST(Overlay, DashesLeaveGaps) {
  Image image(100, 20, kGray);
  draw_outline(image, std::vector<Point>{{5, 10}, {95, 10}},
               {.colour = {0, 255, 0}, .width = 3, .dashed = true, .closed = false, .casing = 0});
  int line = 0;
  for (int x = 5; x < 95; ++x) line += image.at(x, 10) == Colour{0, 255, 0, 255} ? 1 : 0;
  EXPECT_GT(line, 30);
  EXPECT_LT(line, 75);
}

TEST(Overlay, PointsFarOutsideDoNoHarm) {
  Image image(50, 50, kGray);
  const float far = std::numeric_limits<float>::max();
  draw_outline(image, std::vector<Point>{{-far, 25}, {far, 25}, {25, -far}}, {.width = 2});
  EXPECT_NE(image.at(25, 25), kGray);
}

TEST(Overlay, NothingToDrawChangesNothing) {
  Image image(50, 50, kGray);
  const Image before = image;
  draw_outline(image, {});
  draw_legend(image, {});
  draw_label(image, "");
  EXPECT_TRUE(image == before);
  Image empty;
  draw_outline(empty, kSquare);
  draw_label(empty, "text");
  EXPECT_TRUE(empty.empty());
}

TEST(Overlay, LegendAndLabelsStayInTheirCorners) {
  const std::vector<LegendEntry> entries{{"captured", {.colour = kCapturedColour}},
                                         {"simulated", {.colour = kSimulatedColour}}};
  Image image(400, 300, kGray);
  draw_legend(image, entries, Corner::kTopRight);
  EXPECT_GT(changed_pixels(image, {200, 0, 200, 100}), 500);
  EXPECT_EQ(changed_pixels(image, {0, 0, 200, 300}), 0);
  EXPECT_EQ(changed_pixels(image, {0, 150, 400, 150}), 0);
  Image labelled(400, 300, kGray);
  draw_label(labelled, "frame 12", Corner::kBottomLeft);
  EXPECT_GT(changed_pixels(labelled, {0, 250, 200, 50}), 200);
  EXPECT_EQ(changed_pixels(labelled, {0, 0, 400, 250}), 0);
}

TEST(Overlay, TheLegendShowsTheColoursOfItsLines) {
  const std::vector<LegendEntry> entries{{"captured", {.colour = kCapturedColour}},
                                         {"simulated", {.colour = kSimulatedColour}}};
  Image image(400, 300, kGray);
  draw_legend(image, entries);
  const auto has = [&](Colour colour) {
    for (int y = 0; y < 100; ++y) {
      for (int x = 0; x < 200; ++x) {
        if (image.at(x, y) == colour) return true;
      }
    }
    return false;
  };
  EXPECT_TRUE(has(kCapturedColour));
  EXPECT_TRUE(has(kSimulatedColour));
}

TEST(Overlay, TextThatIsNotUtf8IsShownAsFarAsItCan) {
  Image broken(400, 60, kGray);
  Image plain(400, 60, kGray);
  draw_label(broken, "a\xFF\xC3 flame", Corner::kTopLeft, 20);
  draw_label(plain, "a?? flame", Corner::kTopLeft, 20);
  EXPECT_TRUE(broken == plain);
}

TEST(Overlay, DrawsTheSameTwice) {
  const auto drawn = [] {
    Image image(200, 200, kGray);
    draw_outline(image, kSquare);
    draw_label(image, "0.25 s");
    return image;
  };
  EXPECT_TRUE(drawn() == drawn());
}

}  // namespace
}  // namespace wisp::overlay_test
