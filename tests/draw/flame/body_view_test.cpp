// Rings as a camera sees them.

#include "wisp/draw/flame.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace wisp::body_view_test {
namespace {

// Rings of a ball of radius 1 about (0, 1, 0), whose edge is a circle from everywhere.
std::vector<float> ball(int count) {
  std::vector<float> rings;
  for (int k = 0; k < count; ++k) {
    const double angle = 3.14159265 * (k + 0.5) / count;
    for (double number : {0.0, 1 - std::cos(angle), 0.0, std::sin(angle), 0.0, 0.0})
      rings.push_back(static_cast<float>(number));
  }
  return rings;
}

TEST(BodyView, ALevelCameraSeesALeanTurnedByItsAzimuth) {
  const std::vector<float> rings{0, 0, 0, 0.2f, 0, 0, 0.5f, 1, 0.25f, 0.1f, 0.05f, 0.02f};
  std::array<Point, 4> seen{};
  see_body(rings, {}, seen);
  EXPECT_NEAR(seen[1].x, 0.4, 1e-6);
  EXPECT_NEAR(seen[1].y, 0.95, 1e-6);
  EXPECT_NEAR(seen[2].x, 0.6, 1e-6);
  EXPECT_NEAR(seen[2].y, 1.05, 1e-6);
  see_body(rings, {90}, seen);
  EXPECT_NEAR((seen[1].x + seen[2].x) / 2, -0.25, 1e-6);
  EXPECT_NEAR(seen[2].y - seen[1].y, -0.04, 1e-6);
  see_body(rings, {180}, seen);
  EXPECT_NEAR((seen[1].x + seen[2].x) / 2, -0.5, 1e-6);
}

TEST(BodyView, ABallHasARoundEdgeFromAbove) {
  const std::vector<float> rings = ball(60);
  std::vector<Point> seen(120);
  const double raised = 35 * 3.14159265 / 180;
  see_body(rings, {20, 35}, seen);
  int round = 0;
  for (const Point p : seen) {
    const double far = std::hypot(p.x, p.y - std::cos(raised));
    EXPECT_LT(far, 1.01);
    round += std::abs(far - 1) < 0.02 ? 1 : 0;
  }
  EXPECT_GT(round, 70);  // rings near the poles lie within the edge, and show none of their own
}

TEST(BodyView, WhoLooksFromABlowsInto) {
  EXPECT_NEAR(to_the_right({}, 0.5f, 2), 0.5, 1e-6);
  EXPECT_NEAR(to_the_right({90}, 0.5f, 2), -2, 1e-6);
}

}  // namespace
}  // namespace wisp::body_view_test
