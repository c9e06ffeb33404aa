#include "learn/chain/modes/mode_chain.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace wisp::chain::mode_chain_test {
namespace {

using testing::ElementsAre;

const ChainContext& after(const ModeChain& chain, const std::vector<std::uint16_t>& history) {
  for (const ChainContext& context : chain.contexts) {
    if (context.history == history) return context;
  }
  ADD_FAILURE() << "no such history";
  return chain.contexts.front();
}

// Each mode depends on the one two before it.
ModeSequences two_back(int sequences) {
  std::mt19937_64 random(5);
  ModeSequences out;
  for (int k = 0; k < sequences; ++k) {
    std::vector<std::uint16_t> modes = {0, 1};
    while (modes.size() < 60) {
      const bool follows = random() % 10 < 8;
      const auto before = modes[modes.size() - 2];
      modes.push_back(static_cast<std::uint16_t>(follows ? (before + 1) % 3 : random() % 3));
    }
    out.push_back(modes);
  }
  return out;
}

TEST(ModeChain, CountsBecomeProbabilities) {
  const ModeChain chain = estimate_chain({{0, 1, 0, 1, 1}, {1, 0}}, 2, {.history = 1});
  EXPECT_THAT(chain.counts, ElementsAre(0U, 2U, 2U, 1U));
  EXPECT_THAT(after(chain, {0}).probability, ElementsAre(0.0, 1.0));
  EXPECT_THAT(after(chain, {1}).probability, ElementsAre(2.0 / 3, 1.0 / 3));
  EXPECT_THAT(chain.initial, ElementsAre(0.5, 0.5));
}

TEST(ModeChain, NothingCrossesFromOneRecordingToTheNext) {
  const ModeChain chain = estimate_chain({{0, 0}, {1, 1}}, 2, {.history = 2, .min_count = 1});
  EXPECT_THAT(after(chain, {0}).probability, ElementsAre(1.0, 0.0));
  for (const ChainContext& context : chain.contexts) EXPECT_NE(context.history, (std::vector<std::uint16_t>{0, 1}));
}

TEST(ModeChain, WittenAndBellLeaveRoomForWhatWasNotSeen) {
  // After 0: three times 1, once 2; modes in all: 4 × 0, 3 × 1, 1 × 2, so overall 1/2, 3/8, 1/8.
  const ModeChain chain = estimate_chain({{0, 1}, {0, 1}, {0, 1}, {0, 2}}, 3, {.history = 1, .back_off = true});
  // (count + 2 kinds · overall) / (4 + 2)
  EXPECT_THAT(after(chain, {0}).probability,
              ElementsAre(testing::DoubleEq(1.0 / 6), testing::DoubleEq(3.75 / 6), testing::DoubleEq(1.25 / 6)));
}

TEST(ModeChain, WhatStandsForManyCountsAsMany) {
  const ModeChain chain = estimate_chain({{0, 1}, {0, 2}}, 3, {.history = 1}, {{1, 1}, {1, 3}});
  EXPECT_THAT(after(chain, {0}).probability, ElementsAre(0.0, 0.25, 0.75));
  EXPECT_THAT(chain.counts, ElementsAre(0U, 1U, 1U, 0U, 0U, 0U, 0U, 0U, 0U));
}

TEST(ModeChain, AModeThatOnlyEndsRecordingsGoesOnAsModesDo) {
  for (bool back_off : {false, true}) {
    const ModeChain chain = estimate_chain({{0, 1, 0, 2}}, 3, {.history = 1, .back_off = back_off});
    EXPECT_THAT(after(chain, {2}).probability, ElementsAre(0.5, 0.25, 0.25));
  }
}

TEST(ModeChain, EveryRowSumsToOne) {
  for (int history = 1; history <= 5; ++history) {
    for (bool back_off : {false, true}) {
      const ModeChain chain = estimate_chain(two_back(20), 3, {.history = history, .back_off = back_off});
      for (const ChainContext& context : chain.contexts) {
        double sum = 0;
        for (double p : context.probability) sum += p;
        EXPECT_NEAR(sum, 1, 1e-12);
      }
    }
  }
}

TEST(ModeChain, AutomaticHistoryIsAsLongAsTheDataRemember) {
  EXPECT_EQ(best_history(two_back(40), 3, 6).history, 2);
  // Modes without any memory ask for none.
  std::mt19937_64 random(9);
  ModeSequences chance(40, std::vector<std::uint16_t>(50));
  for (auto& sequence : chance) {
    for (auto& mode : sequence) mode = static_cast<std::uint16_t>(random() % 3);
  }
  EXPECT_EQ(best_history(chance, 3, 6).history, 1);
}

TEST(ModeChain, LikelihoodIsThatOfTheTransitions) {
  const ModeChain chain = estimate_chain({{0, 1, 0, 1, 1}, {1, 0}}, 2, {.history = 1});
  EXPECT_NEAR(log_likelihood(chain, {{1, 1, 0}}), (std::log(1.0 / 3) + std::log(2.0 / 3)) / 2, 1e-12);
  EXPECT_TRUE(std::isnan(log_likelihood(chain, {{1}, {0}})));
  // What was never seen costs much, but not everything.
  EXPECT_NEAR(log_likelihood(chain, {{0, 0}}), std::log(1e-6), 1e-9);
}

}  // namespace
}  // namespace wisp::chain::mode_chain_test
