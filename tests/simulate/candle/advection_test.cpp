#include "simulate/candle/flow_equations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wisp::flow::advection_test {
namespace {

const FlowGrid kGrid{20, 16, 0.5F};

struct Ways {
  explicit Ways(float u, float v) : x(kGrid.size(), 0.0F), y(x) {
    Plane scratch_x(x);
    Plane scratch_y(x);
    trace(kGrid, Plane(kGrid.size(), u), Plane(kGrid.size(), v), 0.25F, x, y, scratch_x, scratch_y);
  }
  Plane x, y;
};

TEST(Advection, MovesByWholeCellsExactly) {
  const Ways ways(4.0F, 2.0F);  // 4 m/s for 0.25 s over cells of 0.5 m: two cells right, one up
  ScalarPlane from(kGrid.size(), kAmbient);
  from[kGrid.at(5, 5)] = Float4{1, 2, 900, 3};
  ScalarPlane to = from;
  advect(kGrid, ways.x, ways.y, from, to);
  for (int lane = 0; lane < 4; ++lane) {
    EXPECT_FLOAT_EQ(to[kGrid.at(7, 6)][lane], from[kGrid.at(5, 5)][lane]);
    EXPECT_FLOAT_EQ(to[kGrid.at(5, 5)][lane], kAmbient[lane]);
  }
}

TEST(Advection, BringsInTheSurroundingsFromOutside) {
  const Ways ways(2.0F, 0.0F);
  ScalarPlane from(kGrid.size(), kAmbient);
  for (int j = 0; j < kGrid.ny; ++j)
    for (int i = 0; i < kGrid.nx; ++i) from[kGrid.at(i, j)][kTemperature] = 1000.0F;
  ScalarPlane to = from;
  advect(kGrid, ways.x, ways.y, from, to);
  EXPECT_FLOAT_EQ(to[kGrid.at(0, 8)][kTemperature], kAmbientTemperature);
  EXPECT_FLOAT_EQ(to[kGrid.at(1, 8)][kTemperature], 1000.0F);
}

TEST(Advection, MovesVelocityWithItself) {
  const Ways ways(2.0F, 0.0F);  // one cell right
  Plane u(kGrid.size(), 2.0F);
  u[kGrid.at(4, 4)] = 3.0F;
  Plane to = u;
  advect_u(kGrid, ways.x, ways.y, u, to);
  EXPECT_FLOAT_EQ(to[kGrid.at(5, 4)], 3.0F);
  EXPECT_FLOAT_EQ(to[kGrid.at(4, 4)], 2.0F);
  Plane v(kGrid.size(), 0.0F);
  v[kGrid.at(4, 4)] = 1.0F;
  advect_v(kGrid, ways.x, ways.y, v, to);
  EXPECT_FLOAT_EQ(to[kGrid.at(5, 4)], 1.0F);
}

// The midpoint rule follows a turning flow to third order in the step: a point on a circle keeps its radius.
TEST(Advection, FollowsATurningFlow) {
  const FlowGrid grid{64, 64, 1.0F};
  Plane u(grid.size(), 0.0F);
  Plane v(u);
  for (int j = 0; j <= grid.ny; ++j)
    for (int i = 0; i <= grid.nx; ++i) {
      u[grid.at(i, j)] = -(static_cast<float>(j) + 0.5F - 32.0F);
      v[grid.at(i, j)] = static_cast<float>(i) + 0.5F - 32.0F;
    }
  Plane way_x(u);
  Plane way_y(u);
  Plane scratch_x(u);
  Plane scratch_y(u);
  constexpr float kTurn = 0.1F;
  trace(grid, u, v, kTurn, way_x, way_y, scratch_x, scratch_y);
  const int cell = grid.at(47, 31);  // 15.5 to the right of the axis, 0.5 below
  const double x = 15.5 - static_cast<double>(way_x[cell]);
  const double y = -0.5 - static_cast<double>(way_y[cell]);
  // The midpoint rule's own radius error is turn⁴/8 of the radius, and its angle's turn³/6.
  EXPECT_NEAR(std::hypot(x, y), std::hypot(15.5, 0.5), 16 * 0.0001);
  EXPECT_NEAR(std::atan2(-0.5, 15.5) - std::atan2(y, x), 0.1, 0.0005);
}

TEST(Advection, NeverLooksOutsideTheGridHoweverWildTheWay) {
  ScalarPlane from(kGrid.size(), kAmbient);
  ScalarPlane to = from;
  for (const float wild :
       {1e30F, -1e30F, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    const Plane way(kGrid.size(), wild);
    advect(kGrid, way, way, from, to);
    EXPECT_FLOAT_EQ(to[kGrid.at(10, 10)][kTemperature], kAmbientTemperature);
    const Ways ways(wild, wild);
    advect(kGrid, ways.x, ways.y, from, to);
    EXPECT_FLOAT_EQ(to[kGrid.at(10, 10)][kTemperature], kAmbientTemperature);
  }
}

TEST(Advection, RoundsToZeroWhatIsFarBelowAnything) {
  const Ways ways(1.0F, 0.0F);
  ScalarPlane from(kGrid.size(), Float4{1e-30F, 1e-30F, kAmbientTemperature, 1e-30F});
  ScalarPlane to = from;
  advect(kGrid, ways.x, ways.y, from, to);
  EXPECT_EQ(to[kGrid.at(10, 10)][kFuel], 0.0F);
}

}  // namespace
}  // namespace wisp::flow::advection_test
