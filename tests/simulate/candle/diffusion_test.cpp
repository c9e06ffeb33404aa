#include "simulate/candle/flow_equations.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace wisp::flow::diffusion_test {
namespace {

const FlowGrid kGrid{32, 24, 1.0F};

struct Walled {
  Walled() : flux_x(kGrid.size(), 0.0F), flux_y(flux_x), values(flux_x), scratch(flux_x) {
    for (int j = 0; j < kGrid.ny; ++j)
      for (int i = 0; i < kGrid.nx; ++i) {
        if (i > 0) flux_x[kGrid.at(i, j)] = 1.0F;
        if (j > 0) flux_y[kGrid.at(i, j)] = 1.0F;
      }
  }

  void step(float strength, int stages) {
    const Plane scale(kGrid.size(), strength);
    diffuse(kGrid, {kGrid.nx, kGrid.ny, flux_x.data(), flux_y.data()}, scale, stages, values, scratch);
  }

  double sum() const {
    double total = 0;
    for (int j = 0; j < kGrid.ny; ++j)
      for (int i = 0; i < kGrid.nx; ++i) total += static_cast<double>(values[kGrid.at(i, j)]);
    return total;
  }

  Plane flux_x, flux_y, values, scratch;
};

// A spread of variance 2 D t a direction: exact for the five-point stencil too.
TEST(Diffusion, SpreadsAPointByTwiceDiffusivityTimesTime) {
  Walled gas;
  gas.values[kGrid.at(16, 12)] = 1.0F;
  constexpr float kStrength = 0.7F;
  gas.step(kStrength, rkl1_stages(kStrength));
  double variance = 0;
  for (int j = 0; j < kGrid.ny; ++j)
    for (int i = 0; i < kGrid.nx; ++i)
      variance += (i - 16) * (i - 16) * static_cast<double>(gas.values[kGrid.at(i, j)]);
  EXPECT_NEAR(variance, 2 * 0.7, 1e-5);
}

TEST(Diffusion, LosesNothingThroughWalls) {
  Walled gas;
  gas.values[kGrid.at(0, 0)] = 1.0F;
  gas.values[kGrid.at(31, 23)] = 2.0F;
  for (int n = 0; n < 50; ++n) gas.step(2.0F, rkl1_stages(2.0F));
  EXPECT_NEAR(gas.sum(), 3, 1e-4);
}

TEST(Diffusion, StaysWithinItsLimitsAtManyTimesTheStepOfEuler) {
  Walled gas;
  for (int j = 0; j < kGrid.ny; ++j)
    for (int i = 0; i < kGrid.nx; ++i) gas.values[kGrid.at(i, j)] = (i + j) % 2 == 0 ? 1.0F : 0.0F;
  const int stages = rkl1_stages(8.0F);
  EXPECT_EQ(stages, 9);  // (81 + 9) / 2 / 4 = 11 ≥ 8, and 7 stages reach 7 only
  for (int n = 0; n < 20; ++n) gas.step(8.0F, stages);
  for (int i = 0; i < kGrid.nx; ++i) EXPECT_NEAR(gas.values[kGrid.at(i, 5)], 0.5F, 0.02F);
}

TEST(Diffusion, LeavesLanesAloneThatDoNotDiffuse) {
  Walled walls;
  ScalarPlane values(kGrid.size(), Float4{0, 0, 0, 0});
  ScalarPlane scratch = values;
  values[kGrid.at(10, 10)] = Float4{1, 1, 1, 1};
  const Plane scale(kGrid.size(), 0.5F);
  diffuse(kGrid, {kGrid.nx, kGrid.ny, walls.flux_x.data(), walls.flux_y.data()}, scale, 3, Float4{1, 1, 1, 0}, values,
          scratch);
  EXPECT_FLOAT_EQ(values[kGrid.at(10, 10)][kSoot], 1.0F);
  EXPECT_FLOAT_EQ(values[kGrid.at(11, 10)][kSoot], 0.0F);
  EXPECT_LT(values[kGrid.at(10, 10)][kFuel], 0.5F);
  EXPECT_FLOAT_EQ(values[kGrid.at(11, 10)][kFuel], values[kGrid.at(9, 10)][kFuel]);
}

}  // namespace
}  // namespace wisp::flow::diffusion_test
