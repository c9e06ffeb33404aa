#include "capture/vision/edge_cloud.hpp"

#include <gtest/gtest.h>

#include "capture/support/seen_flame.hpp"
#include "model/bspline.hpp"

namespace wisp::knots_test {
namespace {

using support::cloud_of;
using support::Flame;
using support::Plane;

// A spear: straight sides that bend at one point only.
Plane spear(double lean) {
  Plane plane(160, 180, 8);
  support::paint(plane, 230, 2.0, [&](double x, double y) {
    const double up = (170 - y) / 150;
    if (up < 0 || up > 1) return std::min(170 - y, y - 20.0);
    return (22 * (1 - up) - std::abs(x - 80 - lean * up)) * 0.98;
  });
  return plane;
}

std::vector<EdgeCloud> spears() { return {cloud_of(spear(-6), 118), cloud_of(spear(0), 118), cloud_of(spear(7), 118)}; }

TEST(Knots, GatherWhereTheOutlineBends) {
  const CurveShape uniform = fit_pace(spears(), uniform_knots(8)), placed = choose_shape(spears(), 8);
  EXPECT_EQ(uniform.knots, uniform_knots(8));
  EXPECT_TRUE(valid_knots(placed.knots));
  EXPECT_LT(placed.misfit, 0.8 * uniform.misfit);
  // Two of the four inner knots lie within a tenth of the tip.
  EXPECT_GT(placed.knots[5], 0.4);
  EXPECT_LT(placed.knots[6], 0.6);
}

TEST(Knots, StayUniformWhereNothingIsGained) {
  // A half circle bends alike everywhere.
  Plane plane(200, 120, 8);
  support::paint(plane, 230, 2.0,
                 [](double x, double y) { return std::min(80 - std::hypot(x - 100, y - 100), 100 - y); });
  const std::vector<EdgeCloud> clouds{cloud_of(plane, 118)};
  EXPECT_EQ(choose_shape(clouds, 8).knots, uniform_knots(8));
}

TEST(Knots, MisfitIsAboutTheOverlapThatIsMissing) {
  const std::vector<EdgeCloud> clouds{cloud_of(support::flame_picture(Flame{}), 118)};
  EXPECT_LT(choose_shape(clouds, 16).misfit, 0.02);
  EXPECT_LT(choose_shape(clouds, 8).misfit, 0.05);
  EXPECT_GT(fit_pace(clouds, uniform_knots(5)).misfit, fit_pace(clouds, uniform_knots(8)).misfit);
}

TEST(Knots, APaceAscendsFromNoughtToOne) {
  const CurveShape shape = choose_shape(spears(), 8);
  EXPECT_DOUBLE_EQ(shape.pace.front(), 0);
  EXPECT_DOUBLE_EQ(shape.pace.back(), 1);
  for (std::size_t k = 1; k < shape.pace.size(); ++k) EXPECT_GT(shape.pace[k], shape.pace[k - 1]);
}

}  // namespace
}  // namespace wisp::knots_test
