// The falling plate against its published regimes.

#include "simulate/leaf/leaf_plate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace wisp::leaf_plate_test {
namespace {

using testing::HasSubstr;

// Periods of an independent computation with the same equations, Runge–Kutta steps of 0.001, after 200 units of time;
// they were given to three digits.
TEST(Plate, FluttersWithTheKnownPeriods) {
  const struct {
    double inertia, period;
  } table[] = {{0.2, 3.91}, {0.5, 6.38}, {0.8, 9.28}, {1.1, 15.95}, {1.20, 25.2}, {1.21, 29.0}};
  for (const auto& row : table) {
    const auto fall = watch_plate(row.inertia, 200, 500);
    ASSERT_TRUE(fall);
    EXPECT_EQ(fall->regime, PlateRegime::kFlutter) << row.inertia;
    EXPECT_NEAR(fall->period / row.period, 1, 0.01) << row.inertia;
    EXPECT_NEAR(fall->stall_interval, fall->period / 2, 1e-9) << row.inertia;
  }
}

TEST(Plate, TumblesWithTheKnownHalfTurns) {
  const struct { double inertia, half_turn; } table[] = {{1.23, 14.0}, {1.3, 8.60}, {1.4, 6.41}};
  for (const auto& row : table) {
    const auto fall = watch_plate(row.inertia, 200, 900);
    ASSERT_TRUE(fall);
    EXPECT_EQ(fall->regime, PlateRegime::kTumble) << row.inertia;
    EXPECT_NEAR(fall->period / row.half_turn, 1, 0.01) << row.inertia;
  }
}

// 1.219146, by integrators of scipy with errors bound to 1e-12 (studies/leaf/verify_leaf_plate.py).
TEST(Plate, GoesOverFromTheInertiaOnThatAnIndependentIntegrationFinds) {
  EXPECT_EQ(watch_plate(1.21912, 200, 300)->regime, PlateRegime::kFlutter);
  EXPECT_EQ(watch_plate(1.21917, 200, 300)->regime, PlateRegime::kTumble);
}

TEST(Plate, DoesBothWhereItIsHeavierAndFluttersAgainWhereItIsHeavierStill) {
  EXPECT_EQ(watch_plate(1.8, 200, 600)->regime, PlateRegime::kMixed);
  EXPECT_EQ(watch_plate(2.9, 200, 400)->regime, PlateRegime::kFlutter);
}

TEST(Plate, LosesNoEnergyWithoutDragAndDamping) {
  // Lift and the terms of inertia do no work: what drains I*-weighted energy is drag and damping, never the reverse.
  for (const double inertia : {0.3, 1.2, 3.0}) {
    const PlateState state{.angle = 0.7, .along = 0.9, .across = -0.6, .spin = 0.8};
    const PlateState rate = plate_rate(inertia, state);
    const double power = inertia * state.along * rate.along + (inertia + 1) * state.across * rate.across +
                         0.25 * (inertia + 0.5) * state.spin * rate.spin + rate.y;
    EXPECT_LT(power, 0) << inertia;
  }
}

TEST(Plate, ThatCannotBeWatchedIsExplained) {
  EXPECT_THAT(watch_plate(0).error().message, HasSubstr("inertia"));
  EXPECT_THAT(watch_plate(1, 300, 200).error().message, HasSubstr("from"));
}

}  // namespace
}  // namespace wisp::leaf_plate_test
