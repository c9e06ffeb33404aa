#include "learn/chain/chain_fidelity.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "learn/chain/learn_chain.hpp"
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

TEST(MadeFalls, EveryFallHasItsOwnLengthAndIsAsInALongerPlay) {
  const Recording falls = made_falls({.falls = 20});
  const auto fit = learn_chain(std::span(&falls, 1), LeafRecipe());
  ASSERT_TRUE(fit) << fit.error().message;
  const std::vector<std::size_t> lengths = {300, 9, 40}, longest(3, 300);
  const auto made = made_falls(fit->model, lengths, 1), whole = made_falls(fit->model, longest, 1);
  ASSERT_TRUE(made && whole);
  for (std::size_t k = 0; k < 3; ++k) {
    const Recording cut = slice(whole->falls[k], 0, lengths[k]);
    EXPECT_EQ(made->modes[k].size(), lengths[k]);
    for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(made->falls[k].channels[i].samples, cut.channels[i].samples);
  }
}

}  // namespace
}  // namespace wisp::chain::chain_fidelity_test
