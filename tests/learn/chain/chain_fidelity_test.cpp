#include "learn/chain/chain_fidelity.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "learn/chain/made_falls.hpp"

namespace wisp::chain::chain_fidelity_test {
namespace {

Motion motion_made(std::uint64_t seed) {
  const Recording falls = made_falls({.falls = 24, .seconds = 12, .seed = seed});
  return *motion_of(std::span(&falls, 1));
}

TEST(SpectraApart, OtherFallsOfTheSameKindAreNearTheFloor) {
  const Bounded apart = spectra_apart(motion_made(1), motion_made(2), 1);
  EXPECT_LT(apart.value, 0.3 * apart.ceiling);
  EXPECT_LT(apart.floor, 0.3 * apart.ceiling);
}

TEST(SpectraApart, WhatShakesIsSeenInItsSpectra) {
  Motion shaking = motion_made(1);
  for (MotionPiece& piece : shaking.pieces) {
    for (std::size_t row = 0; row < piece.rows(); ++row)
      piece.velocity[row][2] += 0.3 * std::sin(static_cast<double>(row) * 0.9);
  }
  const Bounded apart = spectra_apart(motion_made(1), shaking, 1);
  EXPECT_GT(apart.value, 3 * apart.floor);
}

TEST(SpectraApart, FallsShorterThanTwoSecondsHaveNone) {
  Recording falls = made_falls({.falls = 24, .seconds = 1});
  const Motion motion = *motion_of(std::span(&falls, 1));
  EXPECT_TRUE(std::isnan(spectra_apart(motion, motion, 1).value));
}

TEST(SpectraApart, TwoSecondsOfFewerThanEightRowsHaveNone) {
  for (double rate_hz : {0.2, 3.0}) {
    const Recording falls = made_falls({.falls = 4, .seconds = 400, .rate_hz = rate_hz, .swing_seconds = 60});
    const Motion motion = *motion_of(std::span(&falls, 1));
    EXPECT_TRUE(std::isnan(spectra_apart(motion, motion, 1).value)) << rate_hz;
  }
}

}  // namespace
}  // namespace wisp::chain::chain_fidelity_test
