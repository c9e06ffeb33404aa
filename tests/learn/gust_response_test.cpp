#include "wisp/learn/gust_response.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "learn/made_falls.hpp"

namespace wisp {
namespace {

using testing::HasSubstr;

// Falls with a gust each, that carries them along as an autoregression of order 1 does.
struct MadePairs {
  Recording windy;
  Recording calm;
};

MadePairs made_pairs(double keeps, double takes, int falls = 24) {
  MadePairs pairs{made_falls({.falls = falls, .seconds = 2}), {}};
  pairs.calm = pairs.windy;
  for (Recording* recording : {&pairs.windy, &pairs.calm}) {
    recording->attributes.push_back({"pair", "made"});
    for (const char* name : {"wind.x", "wind.y", "wind.z"}) {
      recording->channels.push_back({name, "m/s", Role::kInput, std::vector<double>(recording->rows(), 0.0)});
    }
  }
  for (int fall = 0; fall < falls; ++fall) {
    const double direction = fall, speed = 0.5 + 0.05 * fall;
    double change[2] = {}, place[2] = {};
    for (std::size_t row = 0; row < 120; ++row) {
      const std::size_t at = static_cast<std::size_t>(fall) * 120 + row;
      const bool blows = row >= 30 && row < 60;
      const double wind[2] = {blows ? speed * std::cos(direction) : 0, blows ? speed * std::sin(direction) : 0};
      for (std::size_t axis = 0; axis < 2; ++axis) {
        change[axis] = keeps * change[axis] + takes * wind[axis];
        pairs.windy.channels[7 + axis].samples[at] = wind[axis];
        place[axis] += change[axis] / 60;
        pairs.windy.channels[axis].samples[at] += place[axis];
      }
    }
  }
  return pairs;
}

TEST(GustResponse, AnAutoregressionIsFoundAgain) {
  const MadePairs pairs = made_pairs(0.85, 0.12);
  const auto fit = learn_gusts(pairs.windy, pairs.calm, {});
  ASSERT_TRUE(fit) << fit.error().message;
  // Velocities are differences over two rows to either side, which rounds the gust's edges.
  EXPECT_NEAR(fit->response.ground.change[0], 0.85, 0.02);
  EXPECT_NEAR(fit->response.ground.wind[0] / (1 - fit->response.ground.change[0]), 0.8, 0.03);
  EXPECT_GT(fit->figures.fit_percent, 90);
  EXPECT_LT(fit->figures.direction_degrees, 3);
  EXPECT_EQ(fit->inputs.size(), 3U);
}

TEST(GustResponse, WhatTheWindDoesNotMoveHasNoResponse) {
  const MadePairs pairs = made_pairs(0, 0);
  const auto fit = learn_gusts(pairs.windy, pairs.calm, {});
  ASSERT_TRUE(fit);
  EXPECT_LT(fit->figures.largest_change, 1e-6);
}

TEST(GustResponse, PairsThatDoNotMatchAreErrors) {
  const MadePairs pairs = made_pairs(0.8, 0.2);
  EXPECT_THAT(learn_gusts(pairs.windy, slice(pairs.calm, 0, 120 * 5), {}).error().message, HasSubstr("24 and 5"));
  EXPECT_THAT(learn_gusts(pairs.calm, pairs.calm, {}).error().message, HasSubstr("fewer than 4 gusts"));
  EXPECT_THAT(learn_gusts(made_falls(), pairs.calm, {}).error().message, HasSubstr("wind.x"));
  EXPECT_FALSE(learn_gusts(pairs.windy, pairs.calm, {.order = 5}));
}

}  // namespace
}  // namespace wisp
