
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "learn/chain/chain_fit.hpp"
#include "learn/chain/gusts/gust_play.hpp"
#include "learn/chain/learn_chain.hpp"
#include "learn/chain/made_falls.hpp"

namespace wisp::chain::gust_response_test {
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

Result<GustFit> learned(const MadePairs& pairs) {
  const auto both = gust_pairs(pairs.windy, pairs.calm);
  return learn_gusts(*both, both->gusts());
}

Result<GustPlay> played(const Model& model, const MadePairs& pairs) {
  return play_gusts(model, *gust_pairs(pairs.windy, pairs.calm), 0, 1);
}

TEST(GustResponse, AnAutoregressionIsFoundAgain) {
  const MadePairs pairs = made_pairs(0.85, 0.12);
  const auto fit = learned(pairs);
  ASSERT_TRUE(fit) << fit.error().message;
  // Velocities are differences over two rows to either side, which rounds the gust's edges.
  EXPECT_NEAR(fit->response.ground.change, 0.85, 0.02);
  EXPECT_NEAR(fit->response.ground.wind / (1 - fit->response.ground.change), 0.8, 0.03);
  EXPECT_EQ(fit->inputs.size(), 3U);
}

TEST(GustResponse, IsLearnedBesideAChainFromAPairInAnyOrder) {
  MadePairs pairs = made_pairs(0.85, 0.12);
  pairs.windy.source = "windy.csv";
  pairs.calm.source = "calm.csv";
  const Recording falls = made_falls({.falls = 20});
  LeafRecipe recipe;
  recipe.modes = 2;
  const Recording all[] = {pairs.calm, falls, pairs.windy};
  const auto fit = learn_chain(all, recipe);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_TRUE(std::get<ChainModel>(fit->model.dynamics).gust);
  EXPECT_EQ(fit->model.training.sources, (std::vector<std::string>{"made.csv", "windy.csv", "calm.csv"}));
  EXPECT_GT(std::get<double>(fit->report.find("gusts.fit_percent")->value), 80);
  EXPECT_EQ(std::get<std::int64_t>(fit->report.find("gusts.gusts")->value), 10);  // of 24, which were not learned from
  const auto report = validate_chain(fit->model, std::array{pairs.windy, pairs.calm}, 1);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_TRUE(report->find("gusts.halves.direction_degrees.mean_clear"));
  EXPECT_THAT(learn_chain(std::span(all).first(2), recipe).error().message, HasSubstr("is one of 1 recordings"));
  EXPECT_THAT(validate_chain(fit->model, all, 1).error().message, HasSubstr("made.csv: is not one of a pair"));
}

TEST(GustResponse, WhatTheWindDoesNotMoveHasNoResponse) {
  const MadePairs pairs = made_pairs(0, 0);
  const auto fit = learned(pairs);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->response.ground.wind, 0, 1e-6);
  EXPECT_NEAR(fit->response.ground.press, 0, 1e-6);
}

TEST(GustResponse, TwinsOfTwoRatesAreRefused) {
  MadePairs pairs = made_pairs(0.85, 0.12);
  pairs.calm.rate_hz = 30;
  EXPECT_FALSE(gust_pairs(pairs.windy, pairs.calm));
}

TEST(GustResponse, StretchesThatGapsSetAgainstOtherFallsAreRefused) {
  MadePairs pairs = made_pairs(0.85, 0.12);
  pairs.windy.channels[0].samples[3 * 120 + 60] = std::nan("");
  pairs.calm.channels[0].samples[7 * 120 + 60] = std::nan("");
  const auto both = gust_pairs(pairs.windy, pairs.calm);
  ASSERT_FALSE(both);
  EXPECT_THAT(both.error().message, HasSubstr("row 422: a stretch begins here that has no twin"));
}

TEST(GustResponse, PairsThatDoNotMatchAreErrors) {
  const MadePairs pairs = made_pairs(0.8, 0.2);
  EXPECT_THAT(gust_pairs(pairs.windy, slice(pairs.calm, 0, 120 * 5)).error().message, HasSubstr("24 and 5"));
  EXPECT_THAT(learned({pairs.calm, pairs.calm}).error().message, HasSubstr("fewer than 2 gusts"));
  EXPECT_THAT(gust_pairs(made_falls(), pairs.calm).error().message, HasSubstr("wind.x"));
}

// A chain of the calm falls with the response that was learned of the windy ones.
Model blown_model(const MadePairs& pairs) {
  auto chain = fit_chain(std::span(&pairs.calm, 1), {.event = {}, .modes = 3, .holdout = 0});
  auto gusts = learned(pairs);
  std::get<ChainModel>(chain->model.dynamics).gust = gusts->response;
  chain->model.inputs = gusts->inputs;
  return chain->model;
}

TEST(GustPlay, ABankThatIsBlownAtGoesWhereTheWindTookWhatWasRecorded) {
  const MadePairs pairs = made_pairs(0.85, 0.12);
  const auto play = played(blown_model(pairs), pairs);
  ASSERT_TRUE(play) << play.error().message;
  EXPECT_EQ(play->figures.gusts, 24U);
  EXPECT_GT(play->figures.fit_percent, 85);
  EXPECT_LT(play->figures.direction.mean, 5);
  EXPECT_FALSE(play->figures.diverges);
  EXPECT_LT(play->figures.left_after, 0.01);
  EXPECT_TRUE(std::isnan(play->figures.halves_direction.median));  // one clone has no halves
  ASSERT_EQ(play->scenes.size(), 2U);
  EXPECT_EQ(play->scenes[0].recorded.size(), 1U);
  EXPECT_EQ(play->scenes[0].recorded[0].size(), play->scenes[0].blows.size());
}

TEST(GustPlay, AResponseThatBlowsTheOtherWayIsSeen) {
  const MadePairs pairs = made_pairs(0.85, 0.12);
  Model model = blown_model(pairs);
  std::get<ChainModel>(model.dynamics).gust->ground.wind *= -1;
  const auto play = played(model, pairs);
  ASSERT_TRUE(play);
  EXPECT_LT(play->figures.fit_percent, 0);
  EXPECT_GT(play->figures.direction.median, 170);
}

TEST(GustPlay, WhatKeepsGoingDiverges) {
  const MadePairs pairs = made_pairs(0.85, 0.12);
  Model model = blown_model(pairs);
  std::get<ChainModel>(model.dynamics).gust->ground.change = 0.9995;
  const auto play = played(model, pairs);
  ASSERT_TRUE(play);
  EXPECT_TRUE(play->figures.diverges);
}

TEST(GustPlay, AModelWithoutAResponseIsAnError) {
  const MadePairs pairs = made_pairs(0.85, 0.12, 6);
  Model model = blown_model(pairs);
  std::get<ChainModel>(model.dynamics).gust.reset();
  model.inputs.clear();
  EXPECT_THAT(played(model, pairs).error().message, HasSubstr("no response"));
}

TEST(GustPlay, PairsWithoutTheModelsOrientationAreAnError) {
  MadePairs pairs = made_pairs(0.85, 0.12, 6);
  const Model model = blown_model(pairs);
  for (Recording* one : {&pairs.windy, &pairs.calm})
    one->channels.erase(one->channels.begin() + 3, one->channels.begin() + 7);
  const auto play = played(model, pairs);
  ASSERT_FALSE(play);
  EXPECT_THAT(play.error().message, HasSubstr("orientation"));
}

}  // namespace
}  // namespace wisp::chain::gust_response_test
