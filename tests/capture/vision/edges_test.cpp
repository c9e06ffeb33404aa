#include "capture/vision/edge_cloud.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "capture/support/synthetic.hpp"

namespace wisp::edges_test {
namespace {

using support::Plane;

// A disc at a place between pixels, its edge three pixels wide: the level half way up is the circle itself.
struct Disc {
  double x = 30.3, y = 28.7, radius = 17.4;
  Plane plane{64, 60};
  Disc() {
    support::paint(plane, 200, 3.0, [&](double px, double py) { return radius - std::hypot(px - x, py - y); });
  }
};

TEST(LocateEdge, FindsACircleToATwentiethOfAPixel) {
  // The ramp is straight, so that what is left is rounding to whole grey levels (3 px / 200 levels / 2) and the bend of
  // the circle within a pixel (1 / (8 · 17.4) px, each side of bilinear interpolation).
  const Disc disc;
  RegionFinder finder;
  const auto regions = finder.find(disc.plane.view(), 99, 1);
  std::vector<PixelPosition> boundary;
  follow_boundary(disc.plane.view(), 99, {regions[0].seed_x, regions[0].seed_y}, boundary);
  for (const PixelPosition pixel : boundary) {
    const EdgePoint edge = locate_edge(disc.plane.view(), 99, pixel);
    EXPECT_NEAR(std::hypot(edge.x - disc.x, edge.y - disc.y), disc.radius, 0.05);
  }
}

TEST(LocateEdge, NormalPointsOutwards) {
  const Disc disc;
  const EdgePoint right = locate_edge(disc.plane.view(), 99, {47, 29});
  EXPECT_NEAR(right.normal_x, 1, 0.02);
  EXPECT_NEAR(right.normal_y, 0, 0.1);
}

TEST(LocateEdge, OnThePicturesBorderTheBorderIsTheEdge) {
  Plane plane(20, 20);
  plane.fill({5, 0, 10, 20}, 200);
  const EdgePoint top = locate_edge(plane.view(), 100, {10, 0});
  EXPECT_DOUBLE_EQ(top.y, -0.5);
  EXPECT_DOUBLE_EQ(top.normal_y, -1);
  EXPECT_DOUBLE_EQ(locate_edge(plane.view(), 100, {10, 19}).y, 19.5);
}

}  // namespace
}  // namespace wisp::edges_test
