#include "capture/vision/region.hpp"

#include <gtest/gtest.h>

#include <random>

#include "capture/support/overlap.hpp"
#include "capture/support/synthetic.hpp"

namespace wisp::region_test {
namespace {

using support::Plane;

TEST(RegionFinder, GivesBoxAndAreaOfEachRegionLargestFirst) {
  Plane plane(60, 40);
  plane.fill({3, 4, 5, 6}, 200);
  plane.fill({20, 10, 30, 20}, 101);
  RegionFinder finder;
  const auto regions = finder.find(plane.view(), 100, 1);
  ASSERT_EQ(regions.size(), 2u);
  EXPECT_EQ(regions[0].box, (Region{20, 10, 30, 20}));
  EXPECT_EQ(regions[0].area, 600);
  EXPECT_EQ(regions[1].area, 30);
}

TEST(RegionFinder, PixelsThatTouchByACornerBelongTogether) {
  Plane plane(20, 20);
  plane.fill({2, 2, 4, 4}, 255);
  plane.fill({6, 6, 4, 4}, 255);
  plane.fill({0, 10, 2, 2}, 255);
  RegionFinder finder;
  EXPECT_EQ(finder.find(plane.view(), 10, 1).size(), 2u);
}

TEST(RegionFinder, ArmsThatMeetBelowAreOneRegion) {
  Plane plane(30, 20);
  plane.fill({2, 2, 3, 15}, 255);
  plane.fill({20, 5, 3, 12}, 255);
  plane.fill({2, 16, 21, 2}, 255);
  RegionFinder finder;
  const auto regions = finder.find(plane.view(), 10, 1);
  ASSERT_EQ(regions.size(), 1u);
  EXPECT_EQ(regions[0].seed_x, 2);
  EXPECT_EQ(regions[0].seed_y, 2);
}

TEST(RegionFinder, AgreesWithFloodFillOnNoise) {
  std::mt19937 random(3);
  Plane plane(97, 61);
  for (auto& pixel : plane.pixels) pixel = static_cast<std::uint8_t>(random() & 255);
  RegionFinder finder;
  std::size_t count = 0;
  std::int64_t area = 0;
  support::Mask mask{97, 61, std::vector<std::uint8_t>(97 * 61)};
  for (std::size_t k = 0; k < mask.inside.size(); ++k) mask.inside[k] = plane.pixels[k] > 150;
  for (int y = 0; y < 61; ++y) {
    for (int x = 0; x < 97; ++x) {
      if (mask.at(x, y) != 1) continue;
      ++count;
      support::flood(mask, {{x, y}}, 1, 2, true);
    }
  }
  const auto regions = finder.find(plane.view(), 150, 1);
  EXPECT_EQ(regions.size(), count);
  for (const BrightRegion& region : regions) area += region.area;
  EXPECT_EQ(area, std::count(mask.inside.begin(), mask.inside.end(), 2));
}

TEST(FollowBoundary, GoesRoundASquareClockwise) {
  Plane plane(10, 10);
  plane.fill({3, 2, 3, 3}, 255);
  std::vector<PixelPosition> boundary;
  follow_boundary(plane.view(), 100, {3, 2}, boundary);
  const std::vector<PixelPosition> expected{{3, 2}, {4, 2}, {5, 2}, {5, 3}, {5, 4}, {4, 4}, {3, 4}, {3, 3}};
  EXPECT_EQ(boundary, expected);
}

TEST(FollowBoundary, PassesByHoles) {
  Plane plane(20, 20);
  plane.fill({3, 3, 10, 10}, 255);
  plane.fill({6, 6, 3, 3}, 0);
  std::vector<PixelPosition> boundary;
  follow_boundary(plane.view(), 100, {3, 3}, boundary);
  EXPECT_EQ(boundary.size(), 36u);
}

TEST(FollowBoundary, GoesOutAndBackAlongALine) {
  Plane plane(12, 5);
  plane.fill({2, 2, 6, 1}, 255);
  std::vector<PixelPosition> boundary;
  follow_boundary(plane.view(), 100, {2, 2}, boundary);
  EXPECT_EQ(boundary.size(), 10u);
}

TEST(FollowBoundary, OfOnePixelIsThatPixel) {
  Plane plane(5, 5);
  plane.at(2, 2) = 255;
  std::vector<PixelPosition> boundary;
  follow_boundary(plane.view(), 100, {2, 2}, boundary);
  EXPECT_EQ(boundary, (std::vector<PixelPosition>{{2, 2}}));
}

TEST(FollowBoundary, EndsOnAnyShapeAndStaysInIt) {
  std::mt19937 random(11);
  RegionFinder finder;
  std::vector<PixelPosition> boundary;
  for (int trial = 0; trial < 200; ++trial) {
    Plane plane(16, 16);
    for (auto& pixel : plane.pixels) pixel = static_cast<std::uint8_t>(random() & 255);
    for (const BrightRegion& region : finder.find(plane.view(), 110, 1)) {
      follow_boundary(plane.view(), 110, {region.seed_x, region.seed_y}, boundary);
      ASSERT_LE(boundary.size(), 8u * static_cast<std::size_t>(region.area));
      for (const PixelPosition p : boundary) ASSERT_GT(plane.at(p.x, p.y), 110);
    }
  }
}

}  // namespace
}  // namespace wisp::region_test
