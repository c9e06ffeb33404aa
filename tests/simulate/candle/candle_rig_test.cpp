#include "simulate/candle/candle_rig.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "simulate/candle/flame_outline.hpp"

// What takes minutes (both grids, all winds, long runs, resolution) is in studies/rig/verify_rig.cpp.

namespace wisp::candle_rig_test {
namespace {

using testing::HasSubstr;

CandleRig burning(const CandleRigOptions& options = {}, int frames = 60) {
  CandleRig rig = std::move(*CandleRig::create(options));
  for (int frame = 0; frame < frames; ++frame) rig.step_frame(0);
  return rig;
}

TEST(CandleRig, BurnsEvenlyAsACandleDoes) {
  CandleRig rig = burning();
  const FlameOutline before = flame_outline(rig.light_of_frame());
  for (int frame = 0; frame < 12; ++frame) rig.step_frame(0);
  const FlameOutline after = flame_outline(rig.light_of_frame());
  EXPECT_TRUE(rig.state().lit);
  EXPECT_TRUE(rig.state().finite);
  EXPECT_NEAR(rig.state().fuel, 1, 0.01);
  EXPECT_NEAR(rig.state().burning, 1, 0.2);
  EXPECT_GT(after.tip.y, 25);
  EXPECT_LT(after.tip.y, 40);
  EXPECT_NEAR(after.brightness / before.brightness, 1, 0.03);
}

TEST(CandleRig, LeansWithTheWindAndGrowsShorter) {
  CandleRig rig = burning();
  const FlameOutline calm = flame_outline(rig.light_of_frame());
  for (int frame = 0; frame < 40; ++frame) rig.step_frame(0.5);
  const FlameOutline leaning = flame_outline(rig.light_of_frame());
  EXPECT_NEAR(leaning.lean, 27, 27 * 0.25);
  EXPECT_LT(leaning.tip.y, calm.tip.y);
}

TEST(CandleRig, LeansTheOtherWayInWindFromTheOtherSide) {
  CandleRigOptions options;
  options.position = 0.5;
  CandleRig right = burning(options);
  CandleRig left = burning(options);
  for (int frame = 0; frame < 30; ++frame) {
    right.step_frame(0.4);
    left.step_frame(-0.4);
  }
  const FlameOutline a = flame_outline(right.light_of_frame());
  const FlameOutline b = flame_outline(left.light_of_frame());
  EXPECT_GT(a.lean, 15);
  EXPECT_NEAR(b.lean, -a.lean, 0.5);
  EXPECT_NEAR(b.tip.y, a.tip.y, 0.5);
}

TEST(CandleRig, GoesOutInAPuffAndStaysOutUntilItIsLit) {
  CandleRig rig = burning();
  for (int frame = 0; frame < 12; ++frame) rig.step_frame(3);
  for (int frame = 0; frame < 30; ++frame) rig.step_frame(0);
  EXPECT_FALSE(rig.state().lit);
  EXPECT_FALSE(flame_outline(rig.light_of_frame()).found);
  rig.light();
  for (int frame = 0; frame < 36; ++frame) rig.step_frame(0);
  EXPECT_TRUE(rig.state().lit);
  EXPECT_GT(flame_outline(rig.light_of_frame()).tip.y, 25);
}

TEST(CandleRig, OutlivesAMetreASecond) {
  CandleRig rig = burning();
  for (int frame = 0; frame < 24; ++frame) rig.step_frame(1);
  for (int frame = 0; frame < 20; ++frame) rig.step_frame(0);
  EXPECT_TRUE(rig.state().lit);
}

TEST(CandleRig, IsTheSameToTheLastBitForTheSameWind) {
  CandleRig a = burning({}, 10);
  CandleRig b = burning({}, 10);
  for (int frame = 0; frame < 5; ++frame) {
    a.step_frame(0.1 * frame);
    b.step_frame(0.1 * frame);
  }
  EXPECT_EQ(a.light_of_frame().soot, b.light_of_frame().soot);
  EXPECT_EQ(a.light_of_frame().blue, b.light_of_frame().blue);
}

TEST(CandleRig, TakesAbsurdWindForWhatItCanBear) {
  CandleRig calm = burning({}, 10);
  CandleRig nan = burning({}, 10);
  calm.step_frame(0);
  nan.step_frame(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(nan.light_of_frame().soot, calm.light_of_frame().soot);
  for (const double wind : {1e300, -1e300, std::numeric_limits<double>::infinity()}) {
    for (int frame = 0; frame < 5; ++frame) nan.step_frame(wind);
    EXPECT_TRUE(nan.state().finite);
    EXPECT_LT(nan.state().fastest, 12);
  }
}

TEST(CandleRig, KeepsItsTimeStepAtAnyFrameRate) {
  CandleRigOptions options;
  EXPECT_EQ(flow::steps_per_frame(options), 20);
  options.rate_hz = 30;
  EXPECT_EQ(flow::steps_per_frame(options), 40);
  options.rate_hz = 1000;
  options.steps_a_second = 600;
  EXPECT_EQ(flow::steps_per_frame(options), 1);
}

TEST(CandleRig, SaysWhichOptionIsWrong) {
  CandleRigOptions options;
  options.wick_damping = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(CandleRig::create(options).error().message, HasSubstr("wick_damping"));
  options = {};
  options.columns = 20;
  EXPECT_THAT(CandleRig::create(options).error().message, HasSubstr("more columns"));
  options = {};
  options.rows = 16;
  EXPECT_THAT(CandleRig::create(options).error().message, HasSubstr("more rows"));
}

}  // namespace
}  // namespace wisp::candle_rig_test
