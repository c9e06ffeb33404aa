#include "simulate/candle/flow_equations.hpp"

#include <gtest/gtest.h>

namespace wisp::flow::combustion_test {
namespace {

const FlowGrid kGrid{16, 16, 1e-3F};
constexpr float kStep = 1.0F / 1200;

Float4 after(Float4 cell, int steps) {
  const Combustion combustion(kStep);
  ScalarPlane cells(kGrid.size(), kAmbient);
  cells[kGrid.at(8, 8)] = cell;
  for (int n = 0; n < steps; ++n) combustion.burn(kGrid, cells, nullptr);
  return cells[kGrid.at(8, 8)];
}

TEST(Combustion, AStoichiometricMixtureBurnsUpAndHeatsBySeventeenHundredKelvin) {
  const Float4 cell = after(Float4{0.08F, 0.08F, 1400, 0}, 50);
  EXPECT_NEAR(cell[kFuel], 0, 1e-4);
  EXPECT_NEAR(cell[kTemperature], 1400 + 1700, 3);
}

TEST(Combustion, NothingBurnsBelowIgnition) {
  const Float4 cell = after(Float4{0.08F, 0.08F, 890, 0}, 50);
  EXPECT_EQ(cell[kFuel], 0.08F);
  EXPECT_EQ(cell[kTemperature], 890.0F);
}

TEST(Combustion, RichFuelIsLeftOverWhereTheOxygenEnds) {
  const Float4 cell = after(Float4{0.5F, 0.5F, 1400, 0}, 50);
  // Oxygen 1 − Z burns its share Zst/(1 − Zst) of fuel.
  EXPECT_NEAR(cell[kFuel], 0.5 - 0.5 * 0.08 / 0.92, 1e-4);
}

TEST(Combustion, SootGrowsInHotRichGasAndBurnsAwayInHotAir) {
  const Float4 rich = after(Float4{0.16F, 0.08F, 1600, 0}, 20);
  EXPECT_GT(rich[kSoot], 0.5F);
  EXPECT_LT(rich[kSoot], 1.2F);
  const Float4 air = after(Float4{0, 0, 1600, 1}, 20);
  EXPECT_LT(air[kSoot], 0.02F);
}

TEST(Combustion, GlowsWithItsTemperature) {
  const Combustion combustion(kStep);
  ScalarPlane cells(kGrid.size(), kAmbient);
  cells[kGrid.at(1, 1)] = Float4{0, 0, 1800, 1};
  cells[kGrid.at(2, 1)] = Float4{0, 0, 1500, 1};
  cells[kGrid.at(3, 1)] = Float4{0, 0, 800, 1};
  Plane light(kGrid.size(), 0.0F);
  combustion.add_glow(kGrid, cells, light);
  EXPECT_NEAR(light[kGrid.at(1, 1)], 1, 1e-3);
  EXPECT_NEAR(light[kGrid.at(2, 1)], 0.3679, 2e-3);  // e^(−9000 (1/1500 − 1/1800)) = e^−1
  EXPECT_EQ(light[kGrid.at(3, 1)], 0.0F);
}

}  // namespace
}  // namespace wisp::flow::combustion_test
