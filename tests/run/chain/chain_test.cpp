// Banks of segment chains: walks, placement, and the promises that every kind of dynamics keeps.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "model/sample_chain.hpp"
#include "model/sample_model.hpp"
#include "run/chain/chain_stepper.hpp"
#include "run/chain/poses.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"

namespace wisp::chain_test {
namespace {

using poses::bank_of;
using poses::Pose;
using poses::pose_of;

TEST(ChainBank, PlaysEachSegmentStepByStep) {
  Bank bank = bank_of(unblended());
  for (int step = 0; step < 200; ++step) {
    const ChainPlace before = *bank.chain()->place_of(bank.at(0));
    bank.step();
    const ChainPlace after = *bank.chain()->place_of(bank.at(0));
    if (after.step == 0) continue;
    EXPECT_EQ(after.segment, before.segment);
    EXPECT_EQ(after.step, before.step + 1);
  }
}

// The sample sinks at 0.75 m/s, and its segments are recorded at heights of 1.85 to 2 m: what leads back to them, at
// most a tenth of its speed of 0.96 m/s, does not make up for that, but slows the fall by just so much.
TEST(ChainBank, WhereHeightIsBoundedALifeBeginsThereAndJoinsLeadBack) {
  constexpr std::array kHeights{2.0f, 1.9f, 1.85f};
  for (ChainMotion motion : {ChainMotion::kPosition, ChainMotion::kPose}) {
    Bank free = bank_of(sample_chain(motion), 8), bounded = bank_of(bounded_chain(motion), 8);
    std::array<float, 8> begun{};
    for (int slot = 0; slot < 8; ++slot) {
      begun[static_cast<std::size_t>(slot)] = pose_of(bounded, slot)[2];
      EXPECT_FLOAT_EQ(pose_of(bounded, slot)[2], kHeights[bounded.chain()->place_of(bounded.at(slot))->segment]);
    }
    for (int step = 0; step < 600; ++step) {
      free.step();
      bounded.step();
    }
    for (int slot = 0; slot < 8; ++slot) {
      const float risen = pose_of(bounded, slot)[2] - pose_of(free, slot)[2] - begun[static_cast<std::size_t>(slot)];
      EXPECT_NEAR(risen, 0.2 * 0.962 * 10, 0.1) << slot;
    }
  }
}

TEST(ChainBank, ModesFollowEachOtherAsTheChainSays) {
  const Model model = unblended();
  const auto& chain = std::get<ChainModel>(model.dynamics);
  Bank bank = bank_of(model);
  double seen[2][2] = {};
  double after_one_zero[2] = {};
  std::vector<int> modes = {chain.segments.mode[bank.chain()->place_of(bank.at(0))->segment]};
  while (modes.size() < 20000) {
    bank.step();
    const ChainPlace place = *bank.chain()->place_of(bank.at(0));
    if (place.step == 0) modes.push_back(chain.segments.mode[place.segment]);
  }
  for (std::size_t k = 2; k < modes.size(); ++k) {
    if (modes[k - 2] == 1 && modes[k - 1] == 0) {
      ++after_one_zero[modes[k]];
    } else {
      ++seen[modes[k - 1]][modes[k]];
    }
  }
  // Six standard deviations of a share of about 5000.
  EXPECT_NEAR(after_one_zero[0] / (after_one_zero[0] + after_one_zero[1]), 0.125, 0.03);
  EXPECT_NEAR(seen[0][0] / (seen[0][0] + seen[0][1]), 0.25, 0.04);
  EXPECT_NEAR(seen[1][0] / (seen[1][0] + seen[1][1]), 0.5, 0.04);
}

TEST(ChainBank, WithoutChanceEveryInstanceLivesTheSameLifeInALoop) {
  const Model model = sample_chain();
  const auto& segments = std::get<ChainModel>(model.dynamics).segments;
  auto bank = Bank::create(model, {.capacity = 2, .seed = 9});
  ASSERT_TRUE(bank);
  bank->set_noise(0);
  bank->spawn(3);
  bank->spawn(77);
  std::vector<std::uint32_t> walk = {bank->chain()->place_of(bank->at(0))->segment};
  while (walk.size() < 60) {
    bank->step();
    ASSERT_EQ(pose_of(*bank, 0)[2], pose_of(*bank, 1)[2]);
    const ChainPlace place = *bank->chain()->place_of(bank->at(0)), other = *bank->chain()->place_of(bank->at(1));
    ASSERT_TRUE(place.segment == other.segment && place.step == other.step);
    if (place.step == 0) walk.push_back(place.segment);
  }
  // The likeliest beginning is mode 0; the sample's likeliest modes are 1 after 0 and, of two alike, 0 after 1.
  EXPECT_EQ(segments.mode[walk[0]], 0);
  // From its second half on it repeats itself.
  std::size_t round = 1;
  while (round < 15 && !std::equal(walk.begin() + 30, walk.end() - static_cast<std::ptrdiff_t>(round),
                                   walk.begin() + 30 + static_cast<std::ptrdiff_t>(round))) {
    ++round;
  }
  EXPECT_LT(round, 15u);
}

TEST(ChainBank, WhatIsHeldFarFromTheOriginIsCounted) {
  Bank bank = bank_of(sample_chain());
  for (int step = 0; step < 100; ++step) bank.step();
  EXPECT_EQ(bank.clamped().clamped, 0U);
  bank.chain()->place(bank.at(0), {.position = {999'999.9f, 0, 0}, .velocity = {1, 0, 0}});
  for (int step = 0; step < 100; ++step) bank.step();
  EXPECT_GT(bank.clamped().clamped, 20U);
}

TEST(ChainBank, FollowersAreThoseOfTheTable) {
  const Model model = unblended();
  const auto& segments = std::get<ChainModel>(model.dynamics).segments;
  Bank bank = bank_of(model);
  std::uint32_t before = bank.chain()->place_of(bank.at(0))->segment;
  for (int step = 0; step < 5000; ++step) {
    bank.step();
    const ChainPlace place = *bank.chain()->place_of(bank.at(0));
    if (place.step != 0) continue;
    const std::size_t row = (before * 2 + segments.mode[place.segment]) * 2;
    EXPECT_TRUE(segments.follow[row] == place.segment || segments.follow[row + 1] == place.segment);
    before = place.segment;
  }
}

TEST(ChainBank, EveryInstanceLivesTheSameLifeInABankOfAnySize) {
  const Model model = sample_chain();
  Bank many = bank_of(model, 19, 5);
  for (int slot : {0, 7, 18}) {
    auto one = Bank::create(model, {.seed = 5});
    ASSERT_TRUE(one);
    one->spawn(static_cast<std::uint64_t>(slot));
    Bank again = bank_of(model, 19, 5);
    for (int step = 0; step < 100; ++step) {
      one->step();
      again.step();
      EXPECT_EQ(pose_of(*one), pose_of(again, slot));
    }
  }
  EXPECT_NE(pose_of(many, 0), pose_of(many, 1));
}

TEST(ChainBank, ARestoredBankGoesOnWithTheSameBits) {
  const Model model = sample_chain();
  Bank bank = bank_of(model, 5);
  for (int step = 0; step < 37; ++step) bank.step();
  std::vector<std::byte> saved(bank.save_bytes());
  bank.save(saved);
  Bank other = bank_of(model, 5, 99);
  const auto restored = other.restore(saved);
  ASSERT_TRUE(restored) << restored.error().message;
  for (int step = 0; step < 200; ++step) {
    bank.step();
    other.step();
    for (int slot = 0; slot < 5; ++slot) EXPECT_EQ(pose_of(bank, slot), pose_of(other, slot));
  }
  Bank longer = bank_of(sample_chain(ChainMotion::kPosition), 5);
  EXPECT_FALSE(longer.restore(saved));
}

TEST(ChainBank, IsRestoredInTheMidstOfAJoin) {
  const Model model = sample_chain();
  Bank bank = bank_of(model, 3);
  std::vector<std::byte> saved(bank.save_bytes());
  // A segment of the sample takes five steps at least: what is drawn, joined, and begins to fade is all seen.
  for (int step = 0; step < 40; ++step) {
    bank.step();
    bank.save(saved);
    Bank other = bank_of(model, 3, 99);
    ASSERT_TRUE(other.restore(saved));
    Bank same = bank_of(model, 3, 98);
    ASSERT_TRUE(same.restore(saved));
    for (int more = 0; more < 15; ++more) {
      other.step();
      // Saved and restored once more on the way.
      std::vector<std::byte> again(same.save_bytes());
      same.save(again);
      ASSERT_TRUE(same.restore(again));
      same.step();
      for (int slot = 0; slot < 3; ++slot) ASSERT_EQ(pose_of(other, slot), pose_of(same, slot)) << step << ' ' << more;
    }
  }
}

TEST(ChainBank, WhatAnotherVersionSavedIsRefusedWithAReason) {
  Bank bank = bank_of(sample_chain());
  std::vector<std::byte> saved(bank.save_bytes());
  bank.save(saved);
  saved[8] = std::byte{4};
  const auto restored = bank.restore(saved);
  ASSERT_FALSE(restored);
  EXPECT_THAT(restored.error().message,
              testing::HasSubstr("has version 4, this build reads 5: save and restore it with the same version"));
}

TEST(ChainBank, TimeBetweenStepsIsInterpolatedAndQuaternionsStayUnit) {
  const Model model = sample_chain();
  Bank raw = bank_of(model), timed = bank_of(model);
  raw.step();
  const Pose first = pose_of(raw);
  raw.step();
  const Pose second = pose_of(raw);
  timed.advance(timed.step_time() * 2 + timed.step_time() / 4);
  const Pose between = pose_of(timed);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(between[axis], first[axis] + 0.25f * (second[axis] - first[axis]), 1e-6);
  }
  double square = 0;
  for (std::size_t k = 3; k < 7; ++k) square += between[k] * between[k];
  EXPECT_NEAR(square, 1, 1e-6);
}

TEST(ChainBank, EndedAndRebornInstancesBeginAtTheOrigin) {
  Bank bank = bank_of(sample_chain(), 3);
  for (int step = 0; step < 50; ++step) bank.step();
  const InstanceId id = bank.at(1);
  EXPECT_TRUE(bank.reset(id));
  const Pose pose = pose_of(bank, 1);
  EXPECT_EQ((std::array{pose[0], pose[1], pose[2]}), (std::array{0.0f, 0.0f, 0.0f}));
}

TEST(ChainBank, NewbornsHeadEverywhere) {
  Bank bank = bank_of(sample_chain(), 400);
  std::array<int, 4> quadrant{};
  for (int slot = 0; slot < 400; ++slot) {
    const Pose pose = pose_of(bank, slot);
    const double heading = 2 * std::atan2(pose[6], pose[3]) + 8 * std::acos(-1.0);
    ++quadrant[static_cast<std::size_t>(heading / std::acos(0.0)) % 4];
  }
  // Each expects 100 ± 8.7; five deviations.
  for (int count : quadrant) EXPECT_NEAR(count, 100, 44);
}

TEST(ChainBank, LanesThatNobodyLivesInAreNotMoved) {
  const Model model = sample_chain();
  std::vector<std::byte> memory(1 << 20);
  Arena arena(memory);
  ChainStepper<LiveNumbers> stepper(model, std::get<ChainModel>(model.dynamics), Channels{}, 1, arena);
  const RandomKeys keys = random_keys(1);
  const std::array<std::uint64_t, LiveNumbers::kLanes> streams{}, born{};
  std::array<std::uint32_t, LiveNumbers::kLanes> clamped;
  Moment<LiveNumbers> moment{&keys, {streams.data(), born.data(), 0}, clamped.data()};
  for (int lane = 0; lane < LiveNumbers::kLanes; ++lane) stepper.start(0, lane, moment);
  moment.used = 3;
  std::array<float, 7 * LiveNumbers::kLanes> before, after;
  stepper.show(0, before.data());
  stepper.step(0, moment);
  stepper.show(0, after.data());
  for (std::size_t lane = 0; lane < LiveNumbers::kLanes; ++lane) {
    EXPECT_EQ(before[lane] == after[lane], lane >= 3) << lane;
    EXPECT_EQ(clamped[lane], 0U);
  }
}

}  // namespace
}  // namespace wisp::chain_test
