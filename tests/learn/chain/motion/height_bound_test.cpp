#include "learn/chain/motion/segmentation.hpp"

#include <gtest/gtest.h>

#include "learn/chain/made_balls.hpp"
#include "learn/chain/made_falls.hpp"

namespace wisp::chain::height_bound_test {
namespace {

bool bounded(const Recording& recording, const EventSpec& event = {EventKind::kMaximum, "pos.z"}) {
  const auto motion = motion_of(std::span(&recording, 1));
  EXPECT_TRUE(motion) << motion.error().message;
  const auto cut = segment(*motion, std::span(&recording, 1), {.event = event});
  EXPECT_TRUE(cut) << cut.error().message;
  return height_is_bounded(*motion, cut->segments);
}

TEST(HeightBound, ABallThatBouncesStaysBetweenFloorAndCeiling) {
  for (std::uint64_t seed : {1, 2, 3, 4, 5}) EXPECT_TRUE(bounded(made_ball({.seed = seed}))) << seed;
  EXPECT_TRUE(bounded(made_ball({.floor = 300})));
}

// The floor's walk outgrows the bounces with the first. One in a hundred walks would be taken for bounded.
TEST(HeightBound, ARandomWalkAndASteadyClimbHaveNoBound) {
  for (std::uint64_t seed : {1, 2, 3, 4, 5}) {
    EXPECT_FALSE(bounded(made_ball({.rows = 40000, .climb_sd = 0.4, .seed = seed}))) << seed;
    EXPECT_FALSE(bounded(made_ball({.climb = 0.1, .seed = seed}))) << seed;
  }
}

TEST(HeightBound, WhatFallsHasNone) {
  EXPECT_FALSE(bounded(made_falls({.falls = 3, .seconds = 60}), {EventKind::kZero, "forward_speed"}));
}

TEST(HeightBound, AStretchThatIsTooShortDoesNotSay) { EXPECT_FALSE(bounded(made_ball({.rows = 900}))); }

}  // namespace
}  // namespace wisp::chain::height_bound_test
