// What a frame of a segment chain costs, counted by stepping one instance on numbers that count.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "model/sample_chain.hpp"
#include "run/chain/chain_stepper.hpp"
#include "run/lanes/counting.hpp"
#include "wisp/run/cost.hpp"

namespace wisp::chain_cost_test {
namespace {

TEST(ChainCost, PlacementAsThePaperJoinsTakesAtMost31OperationsAFrame) {
  Model model = unblended();
  // Segments as long as a leaf's at 60 frames a second.
  const auto cost = count_operations(model);
  ASSERT_TRUE(cost);
  EXPECT_LE(cost->operations_per_frame, 31);
  EXPECT_GE(cost->operations_per_frame, 22);
}

// Segments as long as a leaf's, 8.5 steps at 60 a second.
TEST(ChainCost, JoinsThatMeetHalfWayTakeAtMost80OperationsAFrame) {
  const auto cost = count_operations(sample_chain());
  ASSERT_TRUE(cost);
  EXPECT_LE(cost->operations_per_frame, 80);
  EXPECT_GE(cost->operations_per_frame, 70);
}

TEST(ChainCost, WhatLiesBetweenStepsIsCounted) {
  const auto cost = count_operations(sample_chain());
  ASSERT_TRUE(cost);
  // Seven numbers in proportion, − × + each, and a quaternion made unit again: 4 ×, 3 +, √, ÷ and 4 ×.
}

// One instance whose arithmetic is counted.
class CountedChain {
 public:
  explicit CountedChain(const Model& model, float ground = kNoGround)
      : inputs_(model.inputs.size()), stepper_(made(model)) {
    stepper_.set_noise(1);
    stepper_.set_ground(ground);
    stepper_.start(0, 0, moment(0));
  }

  /// Operations of one step, in a wind where the model knows one.
  std::int64_t step(Vector3<float> wind = {}) {
    for (std::size_t k = 0; k < inputs_; ++k) stepper_.regressors(0)[k] = CountingReal(wind[k]);
    operation_count = {};
    stepper_.step(0, moment(++steps_));
    return operation_count.numbers + operation_count.words;
  }

  void place(const BodyState<CountingReal>& body) { stepper_.place(0, 0, body); }
  void steer(const Vector3<CountingReal>& target) { stepper_.steer(0, 0, target, 1e6f, 0.1f); }
  std::uint32_t segment() const { return stepper_.place_of(0, 0).segment; }

  /// Operations of showing what lies between the last two steps.
  std::int64_t show_between() {
    std::array<CountingReal, 7> shown;
    operation_count = {};
    stepper_.show_between(0, 0.3f, shown.data());
    return operation_count.numbers + operation_count.words;
  }

 private:
  using Stepper = ChainStepper<CountingNumbers>;

  Stepper made(const Model& model) {
    Arena arena(memory_);
    return {model, std::get<ChainModel>(model.dynamics), Channels{}, 1, arena};
  }

  Moment<CountingNumbers> moment(std::uint64_t step) { return {&keys_, {&none_, &none_, step}, &held_}; }

  std::size_t inputs_;
  std::vector<std::byte> memory_ = std::vector<std::byte>(1 << 20);
  RandomKeys keys_ = random_keys(1);
  std::uint64_t none_ = 0, steps_ = 0;
  std::uint32_t held_ = 0;
  Stepper stepper_;
};

TEST(ChainCost, OperationsAFrameAreTheMeanRoundedOnce) {
  for (const Model& model : {unblended(), sample_chain(), sample_chain(ChainMotion::kPosition)}) {
    constexpr int kFrames = ChainStepper<CountingNumbers>::kCountedFrames;
    CountedChain chain(model);
    for (int frame = 0; frame < kFrames; ++frame) chain.step();
    std::int64_t sum = 0;
    for (int frame = 0; frame < kFrames; ++frame) sum += chain.step();
    const auto cost = count_operations(model);
    ASSERT_TRUE(cost);
    EXPECT_NEAR(static_cast<double>(cost->operations_per_frame), static_cast<double>(sum) / kFrames, 0.51);
  }
}

// The most that any frame takes of a long run that is shown `rate` times a second.
std::int64_t dearest_frame(const Model& model, double rate) {
  CountedChain chain(model);
  std::int64_t most = 0, made = 0;
  for (int frame = 1; frame < 100'000; ++frame) {
    std::int64_t operations = rate == model.rate_hz ? 0 : chain.show_between();
    for (const auto due = static_cast<std::int64_t>(frame * model.rate_hz / rate); made < due; ++made) {
      operations += chain.step();
    }
    most = std::max(most, operations);
  }
  return most;
}

TEST(ChainCost, NoFrameOfALongRunTakesMoreThan300Operations) {
  // A frame that joins draws what follows, places it and spreads what differs.
  for (const Model& model : {sample_chain(), sample_chain(ChainMotion::kPosition)}) {
    for (double rate : {60.0, 61.0, 90.0, 144.0, 1000.0}) EXPECT_LE(dearest_frame(model, rate), 300) << rate;
  }
  EXPECT_LE(dearest_frame(unblended(), 60), 100);
  for (double rate : {61.0, 90.0, 144.0, 1000.0}) EXPECT_LE(dearest_frame(unblended(), rate), 135) << rate;
}

TEST(ChainCost, AFrameThatMakesTwoStepsTakesNoMoreThanBoth) {
  EXPECT_LE(dearest_frame(sample_chain(), 31), 300 + 55 + 34);
}

// The sample with the shortest segments that there can be.
Model hasty_chain(std::array<std::uint16_t, 3> steps) {
  Model model = sample_chain();
  ChainSegments& segments = std::get<ChainModel>(model.dynamics).segments;
  segments.steps.assign(steps.begin(), steps.end());
  segments.rows.resize(7 * segment_rows(segments).back());
  return model;
}

TEST(ChainCost, ShortSegmentsTakeNoMore) {
  for (const auto& steps : {std::array<std::uint16_t, 3>{2, 3, 4}, {1, 1, 12}}) {
    EXPECT_LE(dearest_frame(hasty_chain(steps), 60), 300);
  }
}

// As gusts are learned: with a press.
Model gusty_chain() {
  Model model = windy_chain();
  std::get<ChainModel>(model.dynamics).gust = GustResponse{{0.75, 0.25, 0.125}, {0.5, 0.125, 0.25}};
  return model;
}

TEST(ChainCost, AGustAdds42OperationsToAFrame) {
  const Model model = gusty_chain();
  CountedChain chain(model), calm(model);
  std::int64_t most = 0, max_calm = 0;
  for (int step = 0; step < 100'000; ++step) {
    most = std::max(most, chain.step({1, -2, 0.5f}));
    max_calm = std::max(max_calm, calm.step());
  }
  // What the body feels of the wind 3, half a normal 10, a quarter of the press 8, three numbers 5 each, 6 to move.
  EXPECT_EQ(most - max_calm, 3 + 10 + 8 + 15 + 6);
}

TEST(ChainCost, AfterABodyIsPlacedAFrameTakesAtMost450Operations) {
  CountedChain chain(hasty_chain({1, 1, 12}));
  BodyState<CountingReal> body;
  for (int k = 0; k < 200; ++k) {
    const float x = static_cast<float>(k % 20) * 0.1f - 1, y = static_cast<float>(k / 20) * 0.2f - 1;
    body.orientation = unit<CountingReal>({CountingReal(1.0f), CountingReal(x), CountingReal(y), CountingReal(0.3f)});
    body.rates.velocity = {CountingReal(x), CountingReal(y), CountingReal(-0.7f)};
    chain.place(body);
    EXPECT_EQ(chain.segment(), 2U);  // the one in which it can fade
    for (int step = 0; step < 30; ++step) ASSERT_LE(chain.step(), 450) << k << ' ' << step;
  }
}

// A steered join weighs every segment that may follow, in one frame.
TEST(ChainCost, ASteeredJoinTakesSoManyOperationsACandidate) {
  const Model model = steered_chain();
  const auto& chain = std::get<ChainModel>(model.dynamics);
  const auto cost = count_operations(model);
  ASSERT_TRUE(cost);
  const std::int64_t candidates = chain.segments.breadth * chain.modes;
  EXPECT_GT(cost->steered_operations, 300);
  EXPECT_LE(cost->steered_operations, 350 + 85 * candidates);
  EXPECT_EQ(count_operations(sample_chain())->steered_operations, 0);
  CountedChain steered(model);
  steered.steer({CountingReal(1.0f), CountingReal(2.0f), CountingReal(-3.0f)});
  for (int step = 0; step < 20'000; ++step) ASSERT_LE(steered.step(), cost->steered_operations);
}

TEST(ChainCost, ComingToRestTakesAtMost300OperationsAFrame) {
  for (int drop = 1; drop < 20; ++drop) {
    CountedChain chain(sample_chain(), -0.1f * static_cast<float>(drop));
    for (int step = 0; step < 300; ++step) ASSERT_LE(chain.step(), 300) << drop << ' ' << step;
  }
}

}  // namespace
}  // namespace wisp::chain_cost_test
