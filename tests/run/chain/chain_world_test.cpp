// Chains among other things: wind, ground, and hands that put them somewhere else.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "model/sample_chain.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/chain_facet.hpp"

namespace wisp::chain_world_test {
namespace {

using Pose = std::array<float, 7>;

Bank bank_of(const Model& model, int capacity = 1) {
  auto bank = Bank::create(model, {.capacity = capacity});
  EXPECT_TRUE(bank) << bank.error().message;
  for (int k = 0; k < capacity; ++k) bank->spawn();
  return std::move(bank).value();
}

Pose pose_of(const Bank& bank, int slot = 0) {
  Pose pose{};
  EXPECT_TRUE(bank.outputs(bank.at(slot), pose));
  return pose;
}

TEST(ChainWind, CarriesAFallAlongAndLetsItGo) {
  Bank blown = bank_of(windy_chain()), calm = bank_of(windy_chain());
  const auto drift = [&] {
    const Pose a = pose_of(blown), b = pose_of(calm);
    return std::array{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  };
  const std::array<float, 3> wind = {2, -1, 0.5}, none = {};
  blown.set_common_inputs(wind);
  for (int step = 0; step < 60; ++step) {
    blown.step();
    calm.step();
  }
  // A step's change is the wind's share of what is missing: after the wind's rise, 3 steps less than a second of it.
  const auto after = drift();
  EXPECT_NEAR(after[0], 2 * (60 - 3) / 60.0, 0.01);
  EXPECT_NEAR(after[1], -(60 - 3) / 60.0, 0.01);
  EXPECT_GT(after[2], 0.3);
  blown.set_common_inputs(none);
  for (int step = 0; step < 120; ++step) {
    blown.step();
    calm.step();
  }
  const auto rested = drift();
  EXPECT_NEAR(rested[0], 2, 0.01);
  for (int step = 0; step < 60; ++step) {
    blown.step();
    calm.step();
  }
  // The gust is over to the last bit of the velocity; single precision is left.
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(drift()[k], rested[k], 1e-5);
}

TEST(ChainWind, AbsurdWindIsHeldAndNothingIsNotANumber) {
  Bank bank = bank_of(windy_chain());
  for (float absurd : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1e30f}) {
    const std::array<float, 3> wind = {absurd, absurd, absurd};
    bank.set_common_inputs(wind);
    for (int step = 0; step < 600; ++step) bank.step();
    for (float x : pose_of(bank)) ASSERT_TRUE(std::isfinite(x));
  }
  // Ten seconds at six metres a second to either side.
  EXPECT_LT(std::abs(pose_of(bank)[0]), 130);
}

// Beyond a range of 128 the wind has another unit.
TEST(ChainWind, WhatItDoesDoesNotHangOnItsRange) {
  Model wide = windy_chain();
  for (Input& input : wide.inputs) input.lowest = -(input.highest = 100);
  Bank a = bank_of(windy_chain()), b = bank_of(wide);
  const std::array<float, 3> wind = {2, -1, 0.5};
  for (int step = 0; step < 60; ++step) {
    for (Bank* bank : {&a, &b}) {
      bank->set_common_inputs(wind);
      bank->step();
    }
    for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(pose_of(a)[k], pose_of(b)[k], 1e-5) << step;
  }
}

TEST(ChainWind, OfThreeRangesIsRefused) {
  Model askew = windy_chain();
  askew.inputs[2].highest = 100;
  askew.inputs[2].lowest = -100;
  EXPECT_FALSE(check(askew));
}

TEST(ChainWind, IsSavedAndRestoredInMidGust) {
  Model model = windy_chain();
  auto& gust = *std::get<ChainModel>(model.dynamics).gust;
  gust.ground.press = gust.vertical.press = 0.2;
  Bank bank = bank_of(model, 3), never = bank_of(model, 3), other = bank_of(model, 3);
  const std::array<float, 3> wind = {2, 0, 0};
  for (Bank* one : {&bank, &never}) {
    one->set_common_inputs(wind);
    for (int step = 0; step < 5; ++step) one->step();
  }
  std::vector<std::byte> saved(bank.save_bytes());
  bank.save(saved);
  ASSERT_TRUE(other.restore(saved));
  for (int step = 0; step < 50; ++step) {
    for (Bank* one : {&bank, &never, &other}) one->step();
    EXPECT_EQ(pose_of(bank, 2), pose_of(never, 2));
    EXPECT_EQ(pose_of(bank, 2), pose_of(other, 2));
  }
}

TEST(ChainGround, ALeafComesToRestFlatOnIt) {
  Bank bank = bank_of(sample_chain(), 9);
  bank.chain()->set_ground(-2.0f);
  for (int step = 0; step < 600; ++step) bank.step();
  for (int slot = 0; slot < 9; ++slot) {
    const Pose rest = pose_of(bank, slot);
    EXPECT_EQ(rest[2], -2.0f);
    // The normal's height is that of lying flat.
    EXPECT_NEAR(std::abs(1 - 2 * (rest[4] * rest[4] + rest[5] * rest[5])), 1, 1e-5);
    bank.step();
    EXPECT_EQ(pose_of(bank, slot), rest);
  }
}

// The height of the lowest corner of the sample's body.
double lowest_corner(const Pose& pose) {
  const double across = 2 * (pose[4] * pose[6] - pose[3] * pose[5]),
               along = 2 * (pose[5] * pose[6] + pose[3] * pose[4]);
  return pose[2] - std::abs(across) * 0.0365 - std::abs(along) * 0.0245;
}

TEST(ChainGround, NoCornerSinksInWhileABodyLiesDown) {
  const BodyMoment on_edge{.position = {0, 0, 0.5}, .orientation = {0.7f, 0.7f, 0.1f, 0.05f}, .velocity = {0, 0, -1}};
  Bank bank = bank_of(sample_chain());
  bank.chain()->set_ground(0.0f);
  bank.chain()->place(bank.at(0), on_edge);
  double least = 1;
  for (int step = 0; step < 300; ++step) {
    bank.step();
    least = std::min(least, lowest_corner(pose_of(bank)));
  }
  EXPECT_GT(least, -1e-6);
  EXPECT_EQ(pose_of(bank)[2], 0.0f);
}

TEST(ChainGround, LiesDownFromTheFirstStepOn) {
  const BodyMoment on_edge{.position = {0, 0, 0.05f}, .orientation = {0.7f, 0.7f, 0, 0}, .velocity = {0, 0, -1}};
  Bank bank = bank_of(sample_chain());
  bank.chain()->set_ground(0.0f);
  bank.chain()->place(bank.at(0), on_edge);
  while (lowest_corner(pose_of(bank)) > 1e-6) bank.step();
  const Pose touched = pose_of(bank);
  bank.step();
  const Pose after = pose_of(bank);
  double agreement = 0;
  for (std::size_t k = 3; k < 7; ++k) agreement += static_cast<double>(touched[k]) * after[k];
  // Of a right angle it leans by 2 atan(3s² − 2s³) at first, s = 1 / (60 · 0.35); it fell a little off its edge.
  EXPECT_GT(2 * std::acos(std::min(agreement, 1.0)), 0.6 * 0.0132);
}

TEST(ChainGround, IsSavedAndRestored) {
  Bank bank = bank_of(sample_chain(), 2), other = bank_of(sample_chain(), 2);
  bank.chain()->set_ground(-0.5f);
  std::vector<std::byte> saved(bank.save_bytes());
  bank.save(saved);
  ASSERT_TRUE(other.restore(saved));
  EXPECT_EQ(other.chain()->ground(), -0.5f);
  for (int step = 0; step < 200; ++step) {
    bank.step();
    other.step();
  }
  EXPECT_EQ(pose_of(other), pose_of(bank));
  EXPECT_EQ(pose_of(other)[2], -0.5f);
}

TEST(ChainGround, ARestingBodyOfASlowChainIsRestored) {
  Model slow = sample_chain();
  slow.rate_hz = 1;
  Bank bank = bank_of(slow), other = bank_of(slow);
  bank.chain()->set_ground(1.0f);  // above the start: touched in the first step
  bank.step(3);
  std::vector<std::byte> saved(bank.save_bytes());
  bank.save(saved);
  EXPECT_TRUE(other.restore(saved));
}

TEST(ChainGround, NothingJumpsWhereItTouches) {
  Bank bank = bank_of(sample_chain());
  bank.chain()->set_ground(-1.0f);
  Pose before = pose_of(bank);
  for (int step = 0; step < 300; ++step) {
    bank.step();
    const Pose now = pose_of(bank);
    EXPECT_LT(std::hypot(now[0] - before[0], now[1] - before[1], now[2] - before[2]), 0.025);
    EXPECT_GT(before[3] * now[3] + before[4] * now[4] + before[5] * now[5] + before[6] * now[6], std::cos(0.1));
    before = now;
  }
}

TEST(ChainGround, WhoeverIsPlacedFallsAgain) {
  Bank bank = bank_of(sample_chain());
  bank.chain()->set_ground(-0.5f);
  for (int step = 0; step < 200; ++step) bank.step();
  EXPECT_TRUE(bank.chain()->place(bank.at(0), {.position = {1, 2, 3}}));
  bank.step();
  EXPECT_GT(pose_of(bank)[2], 2.9f);
  bank.chain()->set_ground({});
  for (int step = 0; step < 600; ++step) bank.step();
  EXPECT_LT(pose_of(bank)[2], -0.6f);
}

TEST(ChainPlace, GoesOnFromThePoseAndFadesIntoTheChain) {
  Bank bank = bank_of(sample_chain());
  const BodyMoment body{.position = {5, -3, 10},
                        .orientation = {0.8f, 0.2f, -0.1f, 0.55f},
                        .velocity = {0.5f, 0.3f, -0.6f},
                        .spin = {0, 0, 2}};
  ASSERT_TRUE(bank.chain()->place(bank.at(0), body));
  Pose before = pose_of(bank);
  float size = 0;
  for (float x : body.orientation) size += x * x;
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(before[k], body.position[k]);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(before[3 + k], body.orientation[k] / std::sqrt(size), 1e-3);
  bank.step();
  Pose now = pose_of(bank);
  // The first step goes on with the body's own velocity, the fading bends it a little.
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR((now[k] - before[k]) * 60, body.velocity[k], 0.25);
  for (int step = 0; step < 100; ++step) {
    before = pose_of(bank);
    bank.step();
    now = pose_of(bank);
    EXPECT_LT(std::hypot(now[0] - before[0], now[1] - before[1], now[2] - before[2]), 0.03);
  }
}

TEST(ChainPlace, ChoosesTheSegmentThatBeginsSo) {
  Bank bank = bank_of(sample_chain());
  const Model model = sample_chain();
  const auto& segments = std::get<ChainModel>(model.dynamics).segments;
  for (std::uint32_t segment = 0; segment < 3; ++segment) {
    BodyMoment body;
    const auto row = segment_rows(segments)[segment];
    for (std::size_t k = 0; k < 4; ++k) body.orientation[k] = segments.rows[row * 7 + 3 + k];
    for (std::size_t k = 0; k < 3; ++k) {
      body.velocity[k] = static_cast<float>(segments.rates[segment * 12 + k] * segments.rate_scale[0]);
      body.spin[k] = static_cast<float>(segments.rates[segment * 12 + 3 + k] * segments.rate_scale[1]);
    }
    ASSERT_TRUE(bank.chain()->place(bank.at(0), body));
    EXPECT_EQ(bank.chain()->place_of(bank.at(0))->segment, segment);
  }
}

// A segment's rates at its end say nothing of how it begins.
TEST(ChainPlace, WhatMovesAsASegmentBeginsPlaysThatSegmentAsItIs) {
  Model model = sample_chain();
  auto& segments = std::get<ChainModel>(model.dynamics).segments;
  for (std::size_t k = 0; k < 3; ++k) segments.rates[12 * k + 6] = segments.rates[12 * k + 9] = 2000;
  Bank bank = bank_of(model);
  for (std::uint32_t segment = 0; segment < 3; ++segment) {
    const std::int16_t* row = &segments.rows[7 * segment_rows(segments)[segment]];
    const std::int16_t* rate = &segments.rates[12 * segment];
    BodyMoment body;
    for (std::size_t k = 0; k < 4; ++k) body.orientation[k] = row[3 + k];
    for (std::size_t k = 0; k < 3; ++k) {
      body.velocity[k] = static_cast<float>(rate[k] * segments.rate_scale[0]);
      body.spin[k] = static_cast<float>(rate[3 + k] * segments.rate_scale[1]);
    }
    ASSERT_TRUE(bank.chain()->place(bank.at(0), body));
    ASSERT_EQ(bank.chain()->place_of(bank.at(0))->segment, segment);
    for (int step = 1; step < segments.steps[segment]; ++step) {
      bank.step();
      const Pose pose = pose_of(bank);
      row += 7;
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(pose[k], row[k] * segments.row_scale[0], 1e-5);
      for (std::size_t k = 3; k < 7; ++k) EXPECT_NEAR(pose[k], row[k] * segments.row_scale[1], 1e-3);
    }
  }
}

// All that differs between segments is the axis about which they turn; the body heads elsewhere.
TEST(ChainPlace, ComparesSpinsAsTheBodyHeads) {
  Model model = sample_chain();
  auto& segments = std::get<ChainModel>(model.dynamics).segments;
  constexpr std::array<std::array<std::int16_t, 3>, 3> kSpins{{{2000, 0, 0}, {0, 2000, 0}, {-2000, 0, 0}}};
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      segments.rates[6 * k + axis] = segments.rates[axis];
      segments.rates[6 * k + 3 + axis] = kSpins[k / 2][axis];
    }
  }
  Bank bank = bank_of(model);
  const float half = std::sqrt(0.5f);
  for (std::uint32_t segment = 0; segment < 3; ++segment) {
    const BodyMoment body{.orientation = {half, 0, 0, half},
                          .velocity = {-0.06f, 0.6f, -0.75f},
                          .spin = {-1e-3f * kSpins[segment][1], 1e-3f * kSpins[segment][0], 0}};
    ASSERT_TRUE(bank.chain()->place(bank.at(0), body));
    EXPECT_EQ(bank.chain()->place_of(bank.at(0))->segment, segment);
  }
}

// Speeds and spins are compared in units of what is usual, whatever a metre is.
TEST(ChainPlace, WhatFitsDoesNotHangOnTheUnitOfLength) {
  constexpr float kUnit = 1024;
  Model large = sample_chain();
  auto& segments = std::get<ChainModel>(large.dynamics).segments;
  segments.row_scale[0] *= kUnit;
  segments.rate_scale[0] *= kUnit;
  Bank a = bank_of(sample_chain()), b = bank_of(large);
  std::array<int, 3> chosen{};
  for (int body = 0; body < 60; ++body) {
    const float across = 0.01f * static_cast<float>(body % 12), spin = 0.1f * static_cast<float>(body);
    a.chain()->place(a.at(0), {.velocity = {0.6f, across, -0.75f}, .spin = {0, 0, spin}});
    b.chain()->place(b.at(0), {.velocity = {0.6f * kUnit, across * kUnit, -0.75f * kUnit}, .spin = {0, 0, spin}});
    const std::uint32_t segment = a.chain()->place_of(a.at(0))->segment;
    EXPECT_EQ(segment, b.chain()->place_of(b.at(0))->segment) << body;
    ++chosen[segment];
  }
  for (int count : chosen) EXPECT_GT(count, 3);
}

// Share of segments of mode 1, which the sample's drift says lead back, while steered ahead or back along x.
double share_of_mode_one(float target, bool steered = true) {
  Bank bank = bank_of(steered_chain());
  double ones = 0, all = 0;
  for (int fall = 0; fall < 300; ++fall) {
    // Ahead is along x: headings are drawn.
    bank.chain()->place(bank.at(0), {.velocity = {0.6f, 0, -0.7f}});
    if (steered)
      bank.chain()->steer(bank.at(0), {.position = {target, 0, -0.4f}, .in = std::chrono::milliseconds(600)});
    for (int step = 0; step < 30; ++step) {
      bank.step();
      const ChainPlace place = *bank.chain()->place_of(bank.at(0));
      if (place.step != 0) continue;
      ++all;
      ones += place.segment == 2 ? 1 : 0;
    }
  }
  return ones / all;
}

TEST(ChainSteering, PrefersWhatLeadsToTheTarget) {
  const double free = share_of_mode_one(0, false), ahead = share_of_mode_one(2), back = share_of_mode_one(-2);
  EXPECT_LT(ahead, free - 0.1);
  EXPECT_GT(back, free + 0.1);
}

// However much it would help: mode 1, which leads back, never follows mode 0.
TEST(ChainSteering, TakesNothingThatCannotFollow) {
  Model model = steered_chain();
  auto& chain = std::get<ChainModel>(model.dynamics);
  chain.initial = {1, 0};
  chain.history = 1;
  chain.probabilities = {1, 0, 0.5, 0.5};
  Bank bank = bank_of(model);
  for (int fall = 0; fall < 20; ++fall) {
    bank.chain()->place(bank.at(0), {.velocity = {0.6f, 0, -0.7f}});
    bank.chain()->steer(bank.at(0), {.position = {-1000, 0, 0}, .in = std::chrono::milliseconds(600), .near = 0.01f});
    ASSERT_EQ(bank.chain()->place_of(bank.at(0))->mode, 0);
    for (int step = 0; step < 30; ++step) {
      bank.step();
      ASSERT_EQ(bank.chain()->place_of(bank.at(0))->mode, 0) << step;
    }
  }
}

TEST(ChainSteering, EndsWithItsTimeWithReleaseAndWithAPlace) {
  for (int end : {0, 1, 2}) {
    const SteerTarget target{.position = {-2, 0, -1}, .in = std::chrono::milliseconds(end == 0 ? 300 : 10'000)};
    Bank steered = bank_of(steered_chain()), free = bank_of(steered_chain());
    const BodyMoment start{.velocity = {0.6f, 0, -0.7f}};
    ASSERT_TRUE(steered.chain()->steer(steered.at(0), target));
    for (int step = 0; step < 100; ++step) {
      steered.step();
      free.step();
      if (end == 0 && step == 40) {
        steered.chain()->place(steered.at(0), start);
        free.chain()->place(free.at(0), start);
      }
      if (end == 1 && step == 0) {
        EXPECT_TRUE(steered.chain()->release(steered.at(0)));
      }
      if (end == 2 && step == 0) {
        steered.chain()->place(steered.at(0), start);
        free.chain()->place(free.at(0), start);
      }
    }
    EXPECT_EQ(pose_of(steered), pose_of(free)) << end;
  }
}

TEST(ChainSteering, IsSavedAndRestored) {
  Bank bank = bank_of(steered_chain(), 2), other = bank_of(steered_chain(), 2);
  bank.chain()->steer(bank.at(1), {.position = {-2, 1, -1}, .in = std::chrono::seconds(4)});
  for (int step = 0; step < 30; ++step) bank.step();
  std::vector<std::byte> saved(bank.save_bytes());
  bank.save(saved);
  ASSERT_TRUE(other.restore(saved));
  for (int step = 0; step < 200; ++step) {
    bank.step();
    other.step();
    ASSERT_EQ(pose_of(bank, 1), pose_of(other, 1));
  }
}

TEST(ChainSteering, RefusesWhatIsNoTargetAndChainsThatCannotBeSteered) {
  Bank bank = bank_of(steered_chain());
  const InstanceId id = bank.at(0);
  const auto second = std::chrono::seconds(1);
  EXPECT_FALSE(bank.chain()->steer({}, {.in = second}));
  EXPECT_FALSE(bank.chain()->steer(id, {}));
  EXPECT_FALSE(bank.chain()->steer(id, {.position = {std::numeric_limits<float>::quiet_NaN(), 0, 0}, .in = second}));
  EXPECT_FALSE(bank.chain()->steer(id, {.in = second, .near = 0}));
  EXPECT_FALSE(bank.chain()->steer(id, {.in = std::chrono::seconds(10'001)}));
  EXPECT_TRUE(bank.chain()->steer(id, {.in = second}));
  EXPECT_FALSE(bank.chain()->release({}));
  Bank other = bank_of(sample_chain());
  EXPECT_FALSE(other.chain()->steer(other.at(0), {.in = second}));
}

TEST(ChainPlace, RefusesWhatIsNoBody) {
  Bank bank = bank_of(sample_chain());
  const InstanceId id = bank.at(0);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(bank.chain()->place({}, {}));
  EXPECT_FALSE(bank.chain()->place(id, {.position = {nan, 0, 0}}));
  EXPECT_FALSE(bank.chain()->place(id, {.orientation = {0, 0, 0, 0}}));
  EXPECT_FALSE(bank.chain()->place(id, {.velocity = {0, 1e30f, 0}}));
  EXPECT_TRUE(bank.chain()->place(id, {}));
}

}  // namespace
}  // namespace wisp::chain_world_test
