// When instances go out, how that shows, and how they come back.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "base/hash.hpp"
#include "paths.hpp"
#include "run/bank/bits_of.hpp"
#include "run/bank/mortal_flame.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/cost.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp::extinction_test {
namespace {

using std::chrono::nanoseconds;

// Steps until the instance in slot 0 goes out, at most `most`.
int steps_to_death(Bank& bank, float wind, int most = 1000) {
  bank.set_common_inputs(std::span(&wind, 1));
  for (int k = 1; k <= most; ++k) {
    bank.step();
    if (!bank.extinction()->state_of(bank.at(0))->lit) return k;
  }
  return most + 1;
}

bool all_zero(const std::vector<float>& values) {
  for (float value : values) {
    if (value != 0 || std::signbit(value)) return false;
  }
  return true;
}

TEST(Extinction, AWindOfTheLevelKillsInItsSecondsAndAStrongerOneSooner) {
  for (const auto& [wind, steps] : {std::pair{2.0f, 20}, {-2.0f, 20}, {3.0f, 10}, {4.0f, 7}, {6.0f, 4}}) {
    Bank bank = bank_of(mortal_flame());
    bank.spawn();
    EXPECT_NEAR(steps_to_death(bank, wind), steps, 1) << wind;
  }
}

// What is far away may be played by a model of fewer steps a second.
TEST(Extinction, AModelOfAQuarterOfTheRateDiesAfterTheSameSeconds) {
  for (float wind : {2.0f, 2.5f, 3.0f}) {
    Model slow = mortal_flame();
    slow.rate_hz /= 4;
    Bank near = bank_of(mortal_flame()), far = bank_of(slow);
    near.spawn(), far.spawn();
    EXPECT_NEAR(4 * steps_to_death(far, wind), steps_to_death(near, wind), 4) << wind;
  }
}

TEST(Extinction, WithoutHasteAnyWindAboveTheLevelTakesItsSeconds) {
  for (float wind : {2.0f, 3.0f, 1e9f}) {
    Bank bank = bank_of(mortal_flame(0));
    bank.spawn();
    EXPECT_NEAR(steps_to_death(bank, wind), 20, 1) << wind;
  }
}

TEST(Extinction, OfTwoInputsOneKills) {
  Model model = flame_model();
  model.rate_hz = 100;
  model.inputs.push_back({"fan", "", -1, 1});
  auto& arx = std::get<ArxModel>(model.dynamics);
  arx.orders.nb = arx.orders.nk = OrderMatrix(16, 2);  // the flame hears the wind, and not the fan
  for (int i = 0; i < 16; ++i) arx.orders.nb(i, 0) = 4;
  arx.input_mean.push_back(0);
  for (const int deadly : {0, 1}) {
    model.extinction = mortal_flame().extinction;
    model.extinction->input = deadly;
    for (const int blown : {0, 1}) {
      Bank bank = bank_of(model);
      bank.spawn();
      const float inputs[] = {blown == 0 ? 2.0f : 0.0f, blown == 1 ? 2.0f : 0.0f};
      bank.set_common_inputs(inputs);
      for (int k = 0; k < 30; ++k) bank.step();
      EXPECT_EQ(bank.extinction()->state_of(bank.at(0))->lit, blown != deadly) << deadly << blown;
    }
  }
}

TEST(Extinction, AWindBelowTheLevelNeverKills) {
  Bank bank = bank_of(mortal_flame());
  bank.spawn();
  EXPECT_EQ(steps_to_death(bank, 1.99f, 10000), 10001);
}

TEST(Extinction, AShortGustIsSurvivedAndForgotten) {
  Bank bank = bank_of(mortal_flame());
  const InstanceId id = bank.spawn();
  for (int round = 0; round < 50; ++round) {
    blow(bank, 2, 18);
    blow(bank, 0, 40);
    ASSERT_TRUE(bank.extinction()->state_of(id)->lit) << round;
  }
}

TEST(Extinction, GustsThatFollowCloselyAddUp) {
  Bank bank = bank_of(mortal_flame());
  const InstanceId id = bank.spawn();
  int rounds = 0;
  for (; bank.extinction()->state_of(id)->lit && rounds < 20; ++rounds) {
    blow(bank, 2, 11);
    blow(bank, 0, 8);
  }
  EXPECT_EQ(rounds, 3);  // harm is 0.55, then 0.35 + 0.55, then 0.7 + 0.55
}

TEST(Extinction, AFlameThatIsOutStaysOutWhenTheWindStops) {
  Bank bank = bank_of(mortal_flame());
  const InstanceId id = bank.spawn();
  blow(bank, 3, 50);
  blow(bank, 0, 1000);
  EXPECT_FALSE(bank.extinction()->state_of(id)->lit);
  EXPECT_TRUE(all_zero(outputs_of(bank)));
  std::vector<float> points(2 * bank.polyline_points());
  bank.polylines(points);
  EXPECT_TRUE(all_zero(points));
}

TEST(Extinction, WhatIsSeenShrinksAwayRatherThanVanishing) {
  Bank bank = bank_of(mortal_flame());
  const InstanceId id = bank.spawn();
  bank.set_noise(0);
  steps_to_death(bank, 3);
  float before = bank.extinction()->state_of(id)->size;
  EXPECT_NEAR(before, 0.9f, 0.02f);
  std::vector<float> tip{outputs_of(bank)[9]};
  for (int k = 0; k < 10; ++k) {
    bank.step();
    const float size = bank.extinction()->state_of(id)->size;
    EXPECT_NEAR(size, std::max(before - 25.0f / 255, 0.0f), 0.03f);
    before = size;
    tip.push_back(outputs_of(bank)[9]);
    EXPECT_LE(tip[k + 1], tip[k]);
  }
  EXPECT_GT(tip[4], 0);
  EXPECT_EQ(tip.back(), 0);
}

TEST(Extinction, WhatShrinksIsTheShapeThatItHadWhenItWentOut) {
  Bank bank = bank_of(mortal_flame());
  const InstanceId id = bank.spawn();
  steps_to_death(bank, 3);
  const std::vector<float> last = outputs_of(bank);
  const float size = bank.extinction()->state_of(id)->size;
  for (int k = 0; k < 5; ++k) {
    bank.step();
    const float share = bank.extinction()->state_of(id)->size / size;
    const std::vector<float> now = outputs_of(bank);
    for (std::size_t i = 0; i < now.size(); ++i) EXPECT_NEAR(now[i], share * last[i], 1e-5f) << k << " " << i;
  }
}

TEST(Extinction, OnlyRelightingBringsItBackFromRestAndSmall) {
  Bank bank = bank_of(mortal_flame()), calm = bank_of(mortal_flame());
  const InstanceId id = bank.spawn();
  calm.spawn();
  for (Bank* each : {&bank, &calm}) each->set_noise(0);
  blow(bank, 6, 100);
  blow(bank, 0, 1);
  ASSERT_TRUE(bank.extinction()->relight(id));
  EXPECT_TRUE(bank.extinction()->state_of(id)->lit);
  EXPECT_EQ(bank.extinction()->state_of(id)->size, 0);
  blow(bank, 0, 20);
  blow(calm, 0, 20);
  const float size = bank.extinction()->state_of(id)->size;
  EXPECT_NEAR(size, 0.47f, 0.01f);
  EXPECT_NEAR(outputs_of(bank)[9], size * outputs_of(calm)[9], 1e-5f);
  blow(bank, 0, 20);
  blow(calm, 0, 20);
  EXPECT_NEAR(bank.extinction()->state_of(id)->size, 0.95f, 0.02f);
  blow(bank, 0, 25);
  blow(calm, 0, 25);
  EXPECT_EQ(bank.extinction()->state_of(id)->size, 1);
  EXPECT_EQ(outputs_of(bank), outputs_of(calm));
}

// Lit while it dies, it goes on from the size that it has, and has the recorded one after 0.06 s.
TEST(Extinction, WhatIsLitWhileItDiesGoesOnFromItsSize) {
  Bank bank = bank_of(mortal_flame());
  const InstanceId id = bank.spawn();
  bank.extinction()->extinguish(id);
  blow(bank, 0, 4);
  const float left = bank.extinction()->state_of(id)->size;
  EXPECT_NEAR(left, 0.61f, 0.02f);
  bank.extinction()->relight(id);
  blow(bank, 0, 1);
  EXPECT_NEAR(bank.extinction()->state_of(id)->size, left + (0.02f - left) / 6, 0.01f);
  blow(bank, 0, 5);
  EXPECT_NEAR(bank.extinction()->state_of(id)->size, 36.0f / 255, 0.01f);
}

TEST(Extinction, WhatGoesOutWhileItCatchesDiesFromItsSize) {
  Bank bank = bank_of(mortal_flame());
  const InstanceId id = bank.spawn();
  bank.extinction()->extinguish(id);
  blow(bank, 0, 30);
  bank.extinction()->relight(id);
  blow(bank, 0, 20);
  const float size = bank.extinction()->state_of(id)->size;
  bank.extinction()->extinguish(id);
  blow(bank, 0, 4);
  EXPECT_EQ(bank.extinction()->state_of(id)->size, size);
  blow(bank, 0, 2);
  EXPECT_NEAR(bank.extinction()->state_of(id)->size, 105.0f / 255, 0.01f);
}

// Both recorded events of a kind come, and are the same in every bank.
TEST(Extinction, WhichEventIsPlayedIsDrawn) {
  Bank bank = bank_of(mortal_flame(), 64), again = bank_of(mortal_flame(), 64);
  std::vector<float> sizes[2];
  for (Bank* each : {&bank, &again}) {
    for (int k = 0; k < 64; ++k) each->extinction()->extinguish(each->spawn());
    each->step();
    for (int k = 0; k < 64; ++k) sizes[each == &again].push_back(each->extinction()->state_of(each->at(k))->size);
  }
  EXPECT_EQ(sizes[0], sizes[1]);
  const auto low = std::count_if(sizes[0].begin(), sizes[0].end(), [](float x) { return x < 231.0f / 255; });
  EXPECT_GT(low, 16);
  EXPECT_LT(low, 48);
}

TEST(Extinction, ARuleWithoutEventsBorrowsThoseOfASimulatedCandle) {
  Model model = mortal_flame();
  model.extinction->dying = model.extinction->catching = {};
  for (const double rate : {25.0, 60.0, 240.0}) {
    model.rate_hz = rate;
    Bank bank = bank_of(model);
    const InstanceId id = bank.spawn();
    bank.extinction()->extinguish(id);
    blow(bank, 0, static_cast<int>(0.03 * rate) + 1);
    EXPECT_GT(bank.extinction()->state_of(id)->size, 0.1f) << rate;  // it is no switch
    blow(bank, 0, static_cast<int>(0.1 * rate) + 1);
    EXPECT_EQ(bank.extinction()->state_of(id)->size, 0) << rate;
    bank.extinction()->relight(id);
    blow(bank, 0, 1);
    EXPECT_NEAR(bank.extinction()->state_of(id)->size, 0.66f, 0.02f) << rate;
    blow(bank, 0, static_cast<int>(0.1 * rate));
    EXPECT_NEAR(bank.extinction()->state_of(id)->size, 0.8f, 0.1f) << rate;
    blow(bank, 0, static_cast<int>(0.7 * rate));
    EXPECT_EQ(bank.extinction()->state_of(id)->size, 1) << rate;
  }
}

TEST(Extinction, ARelitFlameIsUnharmedAndGoesOutAgain) {
  Bank bank = bank_of(mortal_flame());
  const InstanceId id = bank.spawn();
  const int first = steps_to_death(bank, 3);
  bank.extinction()->relight(id);
  EXPECT_EQ(steps_to_death(bank, 3), first);
}

TEST(Extinction, ARelitFlamesFlickerIsNotTheOneItWasBornWith) {
  Bank bank = bank_of(mortal_flame());
  const InstanceId id = bank.spawn();
  std::vector<float> born, relit;
  blow(bank, 0, 60);
  born = outputs_of(bank);
  bank.extinction()->extinguish(id);
  blow(bank, 0, 60);
  bank.extinction()->relight(id);
  blow(bank, 0, 60);
  relit = outputs_of(bank);
  ASSERT_EQ(bank.extinction()->state_of(id)->size, 1);
  EXPECT_NE(born, relit);
}

TEST(Extinction, ItCanBePutOutWithoutWind) {
  Bank bank = bank_of(mortal_flame(), 2);
  const InstanceId id = bank.spawn(), other = bank.spawn();
  ASSERT_TRUE(bank.extinction()->extinguish(id));
  blow(bank, 0, 30);
  EXPECT_FALSE(bank.extinction()->state_of(id)->lit);
  EXPECT_TRUE(bank.extinction()->state_of(other)->lit);
  EXPECT_EQ(bank.extinction()->state_of(id)->since_out, nanoseconds(300'000'000));
}

TEST(Extinction, AgesAreOfWhatIsShown) {
  Bank bank = bank_of(mortal_flame());
  const InstanceId id = bank.spawn();
  EXPECT_EQ(bank.extinction()->state_of(id)->since_lit, kNever);
  EXPECT_EQ(bank.extinction()->state_of(id)->since_out, kNever);
  bank.extinction()->extinguish(id);
  bank.advance(nanoseconds(125'000'000));
  EXPECT_EQ(bank.extinction()->state_of(id)->since_out, nanoseconds(115'000'000));  // one step late
  bank.extinction()->relight(id);
  bank.advance(nanoseconds(40'000'000));
  EXPECT_EQ(bank.extinction()->state_of(id)->since_out, nanoseconds(155'000'000));
  EXPECT_EQ(bank.extinction()->state_of(id)->since_lit, nanoseconds(35'000'000));
  blow(bank, 0, 1);
  EXPECT_EQ(bank.extinction()->state_of(id)->since_lit, nanoseconds(50'000'000));
}

TEST(Extinction, SizesBetweenStepsLieBetween) {
  Bank bank = bank_of(mortal_flame());
  const InstanceId id = bank.spawn();
  bank.set_noise(0);
  bank.extinction()->extinguish(id);
  bank.advance(nanoseconds(25'000'000));
  EXPECT_NEAR(bank.extinction()->state_of(id)->size, 0.85f, 0.02f);
}

TEST(Extinction, WhatIsNotANumberIsCalmAndWhatIsAbsurdDoesNotKillAtOnce) {
  Bank bank = bank_of(mortal_flame());
  const InstanceId id = bank.spawn();
  blow(bank, std::numeric_limits<float>::quiet_NaN(), 1000);
  EXPECT_TRUE(bank.extinction()->state_of(id)->lit);
  for (int round = 0; round < 10; ++round) {
    blow(bank, round % 2 ? std::numeric_limits<float>::infinity() : -1e30f, 1);
    blow(bank, 0, 20);
    ASSERT_TRUE(bank.extinction()->state_of(id)->lit) << round;
  }
}

TEST(Extinction, NoSingleStepKillsHoweverHastyTheRule) {
  Model model = mortal_flame(100);
  for (double seconds : {0.001, 0.02, 0.3}) {
    model.extinction->seconds = seconds;
    Bank bank = bank_of(model);
    bank.spawn();
    const int steps = steps_to_death(bank, 1e30f);
    EXPECT_GE(steps, 2) << seconds;
    EXPECT_LE(steps, 3) << seconds;  // twice a half, rounded, may be less than one
  }
}

TEST(Extinction, ResettingOrSpawningAnewLightsIt) {
  Bank bank = bank_of(mortal_flame());
  InstanceId id = bank.spawn();
  blow(bank, 6, 30);
  bank.reset(id);
  EXPECT_TRUE(bank.extinction()->state_of(id)->lit);
  EXPECT_EQ(bank.extinction()->state_of(id)->size, 1);
  EXPECT_EQ(bank.extinction()->state_of(id)->since_out, kNever);
  bank.extinction()->extinguish(id);
  blow(bank, 0, 2);
  bank.reset(id);
  blow(bank, 0, 2);
  EXPECT_EQ(bank.extinction()->state_of(id)->size, 1) << "nor does the event in which it was go on";
  blow(bank, 6, 30);
  bank.end(id);
  EXPECT_FALSE(bank.extinction()->state_of(id));
  EXPECT_FALSE(bank.extinction()->relight(id));
  EXPECT_FALSE(bank.extinction()->extinguish(id));
  id = bank.spawn();
  EXPECT_TRUE(bank.extinction()->state_of(id)->lit);
  EXPECT_FALSE(all_zero(outputs_of(bank)));
}

TEST(Extinction, StepsOfAFlameThatIsOutAreNotCountedAsClamped) {
  Bank bank = bank_of(mortal_flame());
  bank.spawn();
  bank.set_noise(0);
  steps_to_death(bank, 6);
  const auto clamped = bank.clamped().clamped;
  blow(bank, 6, 500);
  EXPECT_EQ(bank.clamped().clamped, clamped);
}

// Wind of one frame for one of many instances: gusts of all strengths that now and then kill.
float gust(std::uint64_t instance, int frame) {
  const std::uint64_t word = (instance * 2654435761U + static_cast<std::uint64_t>(frame / 9) * 40503U) % 1000;
  return static_cast<float>(word) / 250.0f - 1.0f;
}

// Outputs and sizes of 300 frames of the instance of `stream`, among others; lit again whenever it has been out a
// while.
std::vector<float> life(Bank& bank, InstanceId id, std::uint64_t stream) {
  std::vector<float> all, wind(bank.slots()), row(bank.output_count());
  for (int frame = 0; frame < 300; ++frame) {
    for (std::size_t k = 0; k < wind.size(); ++k) wind[k] = gust(k + 50, frame);
    wind[id.slot] = gust(stream, frame);
    bank.set_inputs(wind);
    bank.advance(nanoseconds(13'000'000));
    EXPECT_TRUE(bank.outputs(id, row));
    all.insert(all.end(), row.begin(), row.end());
    const LitState state = *bank.extinction()->state_of(id);
    all.push_back(state.size);
    if (!state.lit && state.since_out > nanoseconds(300'000'000)) bank.extinction()->relight(id);
  }
  return all;
}

TEST(Extinction, AnInstanceLivesAndDiesTheSameInABankOfAnySize) {
  Bank alone = bank_of(mortal_flame());
  const std::vector<float> expected = life(alone, alone.spawn(5), 5);
  int zeros = 0;
  for (std::size_t k = 16; k < expected.size(); k += 17) zeros += expected[k] == 0;
  ASSERT_GT(zeros, 20);
  ASSERT_LT(zeros, 280);
  for (int capacity : {2, 8, 9, 31}) {
    Bank bank = bank_of(mortal_flame(), capacity);
    InstanceId watched;
    for (int k = 0; k < capacity; ++k) {
      const InstanceId id = bank.spawn(k == capacity / 2 ? 5 : 100 + k);
      if (k == capacity / 2) watched = id;
    }
    const std::vector<float> found = life(bank, watched, 5);
    EXPECT_EQ(std::memcmp(found.data(), expected.data(), expected.size() * sizeof(float)), 0) << capacity;
  }
}

// The rule as its definition says it, one number after the other.
TEST(Extinction, TheBanksRuleIsTheDefinition) {
  const Model model = mortal_flame();
  const Extinction& rule = *model.extinction;
  Bank bank = bank_of(model, 40);
  for (int k = 0; k < 40; ++k) bank.spawn();
  std::vector<double> harm(40, 0.0), wind(40);
  std::vector<bool> lit(40, true);
  std::vector<float> inputs(40);
  int deaths = 0;
  for (int frame = 0; frame < 2000; ++frame) {
    for (int k = 0; k < 40; ++k) inputs[k] = gust(k, frame);
    bank.set_inputs(inputs);
    bank.step();
    for (int k = 0; k < 40; ++k) {
      const double w = std::min<double>(std::abs(inputs[k]), Extinction::kMaxWind * rule.level);
      const double rate = w >= rule.level ? (1 + rule.haste * (w / rule.level - 1)) / rule.seconds : -1 / rule.recovery;
      harm[k] = std::clamp(harm[k] + rate / model.rate_hz, 0.0, 1.0);
      const bool dies = lit[k] && harm[k] >= 1;
      if (std::abs(harm[k] - 1) < 1e-5 && harm[k] < 1) continue;  // rounding may decide
      if (dies) lit[k] = false;
      deaths += dies;
      ASSERT_EQ(bank.extinction()->state_of(bank.at(k))->lit, lit[k]) << k << " " << frame;
    }
  }
  EXPECT_GT(deaths, 10);
}

// Some harmed, some in decay, some extinguished, some in re-ignition.
Bank lived_in_bank() {
  Bank bank = bank_of(mortal_flame(), 12);
  for (int k = 0; k < 9; ++k) {
    const InstanceId id = bank.spawn();
    const float wind = 0.6f * static_cast<float>(k);
    bank.set_inputs(id, std::span(&wind, 1));
    bank.advance(nanoseconds(17'000'000));
  }
  bank.advance(nanoseconds(33'000'000));
  for (int slot : {7, 8}) bank.extinction()->relight(bank.at(slot));
  bank.advance(nanoseconds(8'000'000));
  return bank;
}

TEST(Extinction, ASavedBankGoesOnDyingWithTheSameBits) {
  Bank bank = lived_in_bank();
  Bank other = bank_of(mortal_flame(), 12);
  ASSERT_TRUE(other.restore(saved(bank)));
  EXPECT_EQ(saved(other), saved(bank));
  for (int frame = 0; frame < 100; ++frame) {
    ASSERT_EQ(outputs_of(other), outputs_of(bank)) << frame;
    for (int slot = 0; slot < bank.slots(); ++slot) {
      const LitState a = *bank.extinction()->state_of(bank.at(slot)), b = *other.extinction()->state_of(other.at(slot));
      ASSERT_EQ(a.lit, b.lit);
      ASSERT_EQ(a.size, b.size);
      ASSERT_EQ(a.since_lit, b.since_lit);
      ASSERT_EQ(a.since_out, b.since_out);
    }
    if (frame == 40) {
      bank.extinction()->relight(bank.at(5));
      other.extinction()->relight(other.at(5));
    }
    bank.advance(nanoseconds(17'000'000));
    other.advance(nanoseconds(17'000'000));
  }
}

TEST(Extinction, ABankIsNotRestoredFromOneWithAnotherRule) {
  const std::vector<std::byte> bytes = saved(lived_in_bank());
  Model other = mortal_flame();
  other.extinction->level = 2.5;
  Bank bank = bank_of(other, 12);
  EXPECT_FALSE(bank.restore(bytes));
  other.extinction.reset();
  Bank immortal = bank_of(other, 12);
  EXPECT_FALSE(immortal.restore(bytes));
}

TEST(Extinction, LivesThatCannotBeAreRefused) {
  Bank bank = bank_of(mortal_flame());
  bank.spawn();
  blow(bank, 3, 4);
  const std::vector<std::byte> good = saved(bank);
  const std::size_t life =
      good.size() - 48 -
      16 * 4;  // wind, harm, lit, two sizes, event, what is left of the offset, twice, two ages, a shape
  const float wrong[] = {7.0f, -0.5f, 0.5f, 1.5f, std::numeric_limits<float>::quiet_NaN(), 200.0f, 2.0f, -1.0f};
  for (std::size_t field = 0; field < 8; ++field) {
    std::vector<std::byte> bytes = good;
    std::memcpy(&bytes[life + 4 * field], &wrong[field], 4);
    const std::uint64_t hash = hash_bytes(std::span(bytes).subspan(32));
    for (int k = 0; k < 8; ++k) bytes[24 + k] = static_cast<std::byte>(hash >> (8 * k));
    EXPECT_FALSE(bank.restore(bytes)) << field;
  }
  EXPECT_TRUE(bank.restore(good));
}

TEST(Extinction, AShapeThatNoFlameHasIsRefused) {
  Bank bank = bank_of(mortal_flame());
  bank.spawn();
  std::vector<std::byte> bytes = saved(bank);
  const float far = 1e6f;
  std::memcpy(&bytes[bytes.size() - 4], &far, 4);
  const std::uint64_t hash = hash_bytes(std::span(bytes).subspan(32));
  for (int k = 0; k < 8; ++k) bytes[24 + k] = static_cast<std::byte>(hash >> (8 * k));
  EXPECT_FALSE(bank.restore(bytes));
}

TEST(Extinction, WithoutARuleEverythingBurnsForEver) {
  Bank bank = bank_of(flame_model());
  bank.spawn();
  EXPECT_EQ(bank.extinction(), nullptr);
  blow(bank, 1e9f, 100);
  EXPECT_FALSE(all_zero(outputs_of(bank)));
}

TEST(Extinction, AllStatesAreReadAtOnce) {
  Bank bank = lived_in_bank();
  bank.end(bank.at(2));
  std::vector<LitState> states(bank.slots());
  bank.extinction()->states(states);
  for (int slot = 0; slot < bank.slots(); ++slot) {
    const auto one = bank.extinction()->state_of(bank.at(slot));
    EXPECT_EQ(states[slot].lit, one && one->lit) << slot;
    EXPECT_EQ(states[slot].size, one ? one->size : 0) << slot;
  }
}

TEST(Extinction, ItsCostIsCountedAndSmall) {
  const auto cost = count_operations(mortal_flame());
  const auto without = count_operations(flame_model({.wind = InputShape::kEvenOdd}));
  EXPECT_EQ(without->extinction_operations, 0);
  EXPECT_EQ(cost->extinction_operations, 3);
  EXPECT_EQ(cost->worst_operations - cost->operations_per_frame, 3 + 3 + 16);  // while what is shown shrinks or grows
  EXPECT_EQ(cost->operations_per_frame - without->operations_per_frame, cost->extinction_operations);
  EXPECT_EQ(cost->multiply_adds_per_frame, without->multiply_adds_per_frame);
}

// Relit while it still dies, a flame is shown as it was until the next step.
TEST(Extinction, RelightingADyingFlameDoesNotMoveIt) {
  const auto model = read_model(WISP_SOURCE_DIR "/apps/web/public/models/flame.wisp");
  ASSERT_TRUE(model) << model.error().message;
  for (const int dying : {0, 1, 3}) {
    auto bank = Bank::create(*model, {.capacity = 1, .seed = 5});
    const InstanceId id = bank->spawn();
    for (int k = 0; k < 60; ++k) bank->step();
    bank->extinction()->extinguish(id);
    for (int k = 0; k < dying; ++k) bank->step();
    std::vector<float> before(model->outputs.size()), after(before);
    bank->outputs(before);
    bank->extinction()->relight(id);
    bank->outputs(after);
    for (std::size_t i = 0; i < after.size(); ++i) EXPECT_NEAR(after[i], before[i], 1e-5) << dying << " " << i;
  }
}

TEST(Extinction, WhatHappensByHandIsReportedThoughTheLastCallMadeNoStep) {
  Bank bank = bank_of(mortal_flame(), 2);
  const InstanceId id = bank.spawn(), other = bank.spawn();
  bank.step();
  bank.advance(nanoseconds(1000));
  bank.extinction()->extinguish(id);
  EXPECT_TRUE(bank.extinction()->state_of(id)->went_out);
  EXPECT_FALSE(bank.extinction()->state_of(other)->went_out);
  bank.advance(nanoseconds(1000));
  EXPECT_FALSE(bank.extinction()->state_of(id)->went_out);
  bank.extinction()->relight(id);
  EXPECT_TRUE(bank.extinction()->state_of(id)->relit);
  bank.step();
  EXPECT_FALSE(bank.extinction()->state_of(id)->relit);
}

}  // namespace
}  // namespace wisp::extinction_test
