#include "learn/chain/chain_seconds.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "learn/chain/made_falls.hpp"

namespace wisp::chain::chain_seconds_test {
namespace {

Motion motion_made(double scale, std::uint64_t seed = 1) {
  Recording falls = made_falls({.falls = 24, .seconds = 12, .seed = seed});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (double& x : falls.channels[axis].samples) x *= scale;
  }
  return *motion_of(std::span(&falls, 1));
}

TEST(SecondsFidelity, OtherFallsOfTheSameKindAreNearTheFloor) {
  const SecondsFidelity found = seconds_fidelity(motion_made(1), motion_made(1, 2), 500, 1);
  EXPECT_LT(found.spectra.value, 0.3 * found.spectra.ceiling);
  EXPECT_LT(found.spectra.floor, 0.3 * found.spectra.ceiling);
  EXPECT_LT(found.tails.value, found.tails.ceiling);
}

TEST(SecondsFidelity, DeviationsOfTailsAndSpreadAreSharesOfWhatWasRecorded) {
  const SecondsFidelity same = seconds_fidelity(motion_made(1), motion_made(1), 500, 1);
  EXPECT_EQ(same.tails.value, 0);
  EXPECT_EQ(same.spread.value, 0);
  const SecondsFidelity found = seconds_fidelity(motion_made(1), motion_made(0.9), 500, 1);
  EXPECT_NEAR(found.tails.value, 0.1, 1e-9);
  EXPECT_NEAR(found.spread.value, 1 - 0.81, 1e-9);
  EXPECT_NEAR(found.synthesized.vertical_speed[0], 0.9 * found.real.vertical_speed[0], 1e-9);
}

TEST(SecondsFidelity, WhatShakesIsSeenInItsSpectra) {
  Motion shaking = motion_made(1);
  for (MotionPiece& piece : shaking.pieces) {
    for (std::size_t row = 0; row < piece.rows(); ++row)
      piece.velocity[row][2] += 0.3 * std::sin(static_cast<double>(row) * 0.9);
  }
  const SecondsFidelity found = seconds_fidelity(motion_made(1), shaking, 500, 1);
  EXPECT_GT(found.spectra.value, 3 * found.spectra.floor);
}

TEST(SecondsFidelity, OneFallHasNoFloor) {
  const Recording fall = made_falls({.falls = 1, .seconds = 12});
  const Motion motion = *motion_of(std::span(&fall, 1));
  const SecondsFidelity found = seconds_fidelity(motion, motion, 500, 1);
  EXPECT_TRUE(std::isnan(found.tails.floor));
  EXPECT_EQ(found.tails.value, 0);
}

TEST(SecondsFidelity, WhatFallsStraightHasNoShareOfItsSpread) {
  Motion straight = motion_made(1);
  for (MotionPiece& piece : straight.pieces) {
    for (Triple& at : piece.position) at[0] = at[1] = 1e-9 * at[2];
  }
  EXPECT_TRUE(std::isnan(seconds_fidelity(straight, motion_made(1), 500, 1).spread.value));
}

TEST(SecondsFidelity, FallsShorterThanTwoSecondsHaveNone) {
  Recording falls = made_falls({.falls = 24, .seconds = 1});
  const Motion motion = *motion_of(std::span(&falls, 1));
  EXPECT_TRUE(std::isnan(seconds_fidelity(motion, motion, 500, 1).spectra.value));
}

}  // namespace
}  // namespace wisp::chain::chain_seconds_test
