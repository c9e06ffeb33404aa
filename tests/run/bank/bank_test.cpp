#include "wisp/run/bank.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "model/sample_model.hpp"
#include "run/flame_model.hpp"

namespace wisp::bank_test {
namespace {

using std::chrono::nanoseconds;
using testing::Each;
using testing::FloatNear;
using testing::HasSubstr;
using testing::Pointwise;

Bank bank_of(const Model& model, const BankOptions& options) {
  auto bank = Bank::create(model, options);
  EXPECT_TRUE(bank) << bank.error().message;
  return std::move(bank).value();
}

std::vector<float> outputs_of(const Bank& bank, InstanceId id) {
  std::vector<float> values(bank.output_count());
  EXPECT_TRUE(bank.outputs(id, values));
  return values;
}

std::vector<float> all_outputs(const Bank& bank) {
  std::vector<float> values(static_cast<std::size_t>(bank.slots()) * bank.output_count());
  bank.outputs(values);
  return values;
}

// Instances.

TEST(Bank, KnowsItsModel) {
  const Bank bank = bank_of(flame_model(), {.capacity = 5, .polyline_points = 40});
  EXPECT_EQ(bank.capacity(), 5);
  EXPECT_EQ(bank.size(), 0);
  EXPECT_EQ(bank.slots(), 0);
  EXPECT_EQ(bank.input_count(), 1);
  EXPECT_EQ(bank.output_count(), 16);
  EXPECT_EQ(bank.polyline_points(), 40);
  EXPECT_EQ(bank.step_time(), nanoseconds(33'333'333));
}

TEST(Bank, InstancesTakeTheLowestEmptySlot) {
  Bank bank = bank_of(flame_model(), {.capacity = 3});
  const InstanceId a = bank.spawn(), b = bank.spawn(), c = bank.spawn();
  EXPECT_EQ(a.slot, 0U);
  EXPECT_EQ(b.slot, 1U);
  EXPECT_EQ(c.slot, 2U);
  ASSERT_TRUE(bank.end(b));
  ASSERT_TRUE(bank.end(a));
  EXPECT_EQ(bank.slots(), 3);
  EXPECT_EQ(bank.spawn().slot, 0U);
  EXPECT_EQ(bank.spawn().slot, 1U);
  EXPECT_EQ(bank.size(), 3);
}

TEST(Bank, AFullBankSpawnsNothing) {
  Bank bank = bank_of(flame_model(), {.capacity = 1});
  ASSERT_TRUE(bank.valid(bank.spawn()));
  EXPECT_FALSE(bank.valid(bank.spawn()));
  EXPECT_EQ(bank.size(), 1);
}

TEST(Bank, AnEndedInstancesIdStaysInvalid) {
  Bank bank = bank_of(flame_model(), {.capacity = 2});
  const InstanceId first = bank.spawn();
  ASSERT_TRUE(bank.end(first));
  const InstanceId second = bank.spawn();
  EXPECT_EQ(second.slot, first.slot);
  EXPECT_FALSE(bank.valid(first));
  EXPECT_TRUE(bank.valid(second));
  EXPECT_FALSE(bank.end(first));
  EXPECT_FALSE(bank.reset(first));
  EXPECT_FALSE(bank.valid({}));
  EXPECT_FALSE(bank.valid({1000, 1}));
  EXPECT_EQ(bank.at(0), second);
  EXPECT_FALSE(bank.valid(bank.at(1)));
  EXPECT_FALSE(bank.valid(bank.at(-1)));
}

TEST(Bank, SlotsShrinkWhenTheHighestInstancesEnd) {
  Bank bank = bank_of(flame_model(), {.capacity = 20});
  std::vector<InstanceId> ids;
  for (int k = 0; k < 20; ++k) ids.push_back(bank.spawn());
  for (int k = 5; k < 20; ++k) ASSERT_TRUE(bank.end(ids[k]));
  EXPECT_EQ(bank.slots(), 5);
  EXPECT_EQ(bank.size(), 5);
}

TEST(Bank, RowsOfEmptySlotsAreZeros) {
  Bank bank = bank_of(flame_model(), {.capacity = 3, .polyline_points = 4});
  const InstanceId first = bank.spawn();
  bank.spawn();
  ASSERT_TRUE(bank.end(first));
  bank.step();
  std::vector<float> values(2 * 16, 7.0f);
  bank.outputs(values);
  EXPECT_THAT(std::vector(values.begin(), values.begin() + 16), Each(0.0f));
  EXPECT_NE(values[16], 0.0f);
  std::vector<float> points(2 * 4 * 2, 7.0f);
  bank.polylines(points);
  EXPECT_THAT(std::vector(points.begin(), points.begin() + 8), Each(0.0f));
}

TEST(Bank, AnInstanceStartsAtTheOperatingPoint) {
  const Model model = flame_model();
  Bank bank = bank_of(model, {});
  const std::vector<float> outputs = outputs_of(bank, bank.spawn());
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    EXPECT_EQ(outputs[i], static_cast<float>(std::get<ArxModel>(model.dynamics).output_mean[i]));
  }
}

TEST(Bank, ResetGivesAnInstanceItsLifeAgain) {
  Bank bank = bank_of(flame_model(), {.capacity = 2});
  const InstanceId id = bank.spawn();
  std::vector<std::vector<float>> first;
  for (int k = 0; k < 20; ++k) {
    bank.step();
    first.push_back(outputs_of(bank, id));
  }
  ASSERT_TRUE(bank.reset(id));
  for (int k = 0; k < 20; ++k) {
    bank.step();
    EXPECT_EQ(outputs_of(bank, id), first[k]) << k;
  }
}

TEST(Bank, ResetOfAllAlsoTurnsTimeBack) {
  Bank bank = bank_of(flame_model(), {.capacity = 2});
  bank.spawn();
  bank.spawn();
  EXPECT_EQ(bank.advance(nanoseconds(40'000'000)), 1);
  bank.reset();
  EXPECT_EQ(bank.advance(nanoseconds(33'333'332)), 0);
  EXPECT_EQ(bank.advance(nanoseconds(1)), 1);
}

// Inputs.

TEST(Bank, WindMovesTheFlame) {
  Bank bank = bank_of(flame_model(), {.capacity = 2});
  bank.set_noise(0);
  const InstanceId calm = bank.spawn(), blown = bank.spawn();
  ASSERT_TRUE(bank.set_inputs(blown, std::vector<float>{0.8f}));
  for (int k = 0; k < 50; ++k) bank.step();
  EXPECT_GT(outputs_of(bank, blown)[8], outputs_of(bank, calm)[8] + 0.1f);  // p4.x
  EXPECT_LT(outputs_of(bank, blown)[9], outputs_of(bank, calm)[9]);         // p4.y
}

TEST(Bank, AllThreeWaysToSetInputsAgree) {
  Bank bank = bank_of(sample_model(), {.capacity = 9, .seed = 3});
  Bank one_by_one = bank_of(sample_model(), {.capacity = 9, .seed = 3});
  Bank common = bank_of(sample_model(), {.capacity = 9, .seed = 3});
  std::vector<InstanceId> ids;
  for (int k = 0; k < 9; ++k) {
    ids.push_back(one_by_one.spawn());
    bank.spawn();
    common.spawn();
  }
  const std::vector<float> wind(9, -0.7f);
  bank.set_inputs(wind);
  common.set_common_inputs(std::span(wind).first(1));
  for (InstanceId id : ids) ASSERT_TRUE(one_by_one.set_inputs(id, std::span(wind).first(1)));
  for (int k = 0; k < 5; ++k) {
    bank.step();
    common.step();
    one_by_one.step();
  }
  EXPECT_EQ(all_outputs(bank), all_outputs(common));
  EXPECT_EQ(all_outputs(bank), all_outputs(one_by_one));
}

TEST(Bank, AGustFromTheRightIsTheMirrorImageOfOneFromTheLeft) {
  Model model = flame_model({.wind = InputShape::kEvenOdd});
  std::get<ArxModel>(model.dynamics).output_mean.assign(16, 0.0);
  for (Output& output : model.outputs) output.lowest = -(output.highest = 0.4);
  std::get<ArxModel>(model.dynamics).input_mean.assign(6, 0.0);
  for (std::vector<double>& row : std::get<ArxModel>(model.dynamics).theta) {
    const std::size_t other = &row - std::get<ArxModel>(model.dynamics).theta.data();
    for (std::size_t k = 0; k < 4; ++k) row[other % 2 == 0 ? 4 + k : k] = 0;  // x and y apart, so that x mirrors
  }
  Bank bank = bank_of(model, {.capacity = 2});
  bank.set_noise(0);
  const InstanceId left = bank.spawn(), right = bank.spawn();
  bank.set_inputs(std::vector<float>{0.5f, -0.5f});
  for (int k = 0; k < 30; ++k) bank.step();
  const std::vector<float> a = outputs_of(bank, left), b = outputs_of(bank, right);
  for (int point = 0; point < 8; ++point) {
    EXPECT_EQ(a[2 * point], -b[2 * point]);
    EXPECT_EQ(a[2 * point + 1], b[2 * point + 1]);
    EXPECT_NE(a[2 * point], 0.0f);
  }
}

// Noise.

TEST(Bank, WithoutNoiseAStillFlameComesToRest) {
  Bank bank = bank_of(flame_model(), {});
  const InstanceId id = bank.spawn();
  bank.set_noise(0);
  for (int k = 0; k < 400; ++k) bank.step();
  const std::vector<float> before = outputs_of(bank, id);
  bank.step();
  EXPECT_THAT(outputs_of(bank, id), Pointwise(FloatNear(1e-6f), before));
}

TEST(Bank, NoiseScaleIsHeldToItsRange) {
  Bank bank = bank_of(flame_model(), {});
  EXPECT_EQ(bank.noise(), 1.0f);
  bank.set_noise(-1);
  EXPECT_EQ(bank.noise(), 0.0f);
  bank.set_noise(NAN);
  EXPECT_EQ(bank.noise(), 0.0f);
  bank.set_noise(1e30f);
  EXPECT_EQ(bank.noise(), 10.0f);
  bank.set_noise(1e-30f);
  EXPECT_EQ(bank.noise(), 0.0f);
}

// Time.

TEST(Bank, AdvanceMakesTheStepsThatFallIntoTheTime) {
  Bank bank = bank_of(flame_model(), {});
  bank.spawn();
  EXPECT_EQ(bank.advance(nanoseconds(10'000'000)), 0);
  EXPECT_EQ(bank.advance(nanoseconds(23'333'332)), 0);
  EXPECT_EQ(bank.advance(nanoseconds(1)), 1);
  EXPECT_EQ(bank.advance(nanoseconds(333'333'330)), 10);
  EXPECT_EQ(bank.advance(nanoseconds(0)), 0);
}

TEST(Bank, AnyFrameRateShowsTheSameMotion) {
  Bank slow = bank_of(flame_model(), {}), fast = bank_of(flame_model(), {});
  const InstanceId a = slow.spawn(), b = fast.spawn();
  int steps = 0;
  for (int second = 0; second < 3; ++second) {
    steps += slow.advance(std::chrono::seconds(1));
    for (int k = 0; k < 1000; ++k) fast.advance(nanoseconds(1'000'000));
    EXPECT_EQ(outputs_of(slow, a), outputs_of(fast, b));
  }
  EXPECT_EQ(steps, 90);
}

TEST(Bank, BetweenStepsOutputsGoStraightFromOneToTheNext) {
  Bank stepped = bank_of(flame_model(), {}), timed = bank_of(flame_model(), {});
  const InstanceId a = stepped.spawn(), b = timed.spawn();
  stepped.step();
  const std::vector<float> first = outputs_of(stepped, a);
  stepped.step();
  const std::vector<float> second = outputs_of(stepped, a);
  ASSERT_EQ(timed.advance(2 * timed.step_time()), 2);
  const std::vector<float> at_first = outputs_of(timed, b);
  ASSERT_EQ(timed.advance(nanoseconds(8'333'333)), 0);  // a quarter of a step
  const std::vector<float> quarter = outputs_of(timed, b);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(at_first[i], first[i]);
    EXPECT_NEAR(quarter[i], first[i] + 0.25f * (second[i] - first[i]), 1e-6);
  }
}

TEST(Bank, NegativeTimeCountsAsNoneAndALongPauseIsCut) {
  Bank bank = bank_of(flame_model(), {});
  bank.spawn();
  EXPECT_EQ(bank.advance(nanoseconds(-5'000'000'000)), 0);
  EXPECT_EQ(bank.advance(nanoseconds::max()), 300);
  EXPECT_EQ(bank.advance(nanoseconds::min()), 0);
}

// View.

TEST(Bank, APolylineLiesOnTheSplineOfItsControlPoints) {
  const Model model = flame_model();
  Bank bank = bank_of(model, {.capacity = 10, .polyline_points = 17});
  std::vector<InstanceId> ids;
  for (int k = 0; k < 10; ++k) ids.push_back(bank.spawn());
  bank.step();
  bank.advance(nanoseconds(5'000'000));
  std::vector<float> all(10 * 17 * 2), one(17 * 2);
  bank.polylines(all);
  const auto& knots = std::get<OutlineView>(model.view).knots;
  for (int k = 0; k < 10; ++k) {
    ASSERT_TRUE(bank.polyline(ids[k], one));
    EXPECT_EQ(one, std::vector(all.begin() + k * 34, all.begin() + (k + 1) * 34));
    const std::vector<float> controls = outputs_of(bank, ids[k]);
    for (int m = 0; m < 17; ++m) {
      const BasisWeights weights = basis(knots, m / 16.0);
      for (int c = 0; c < 2; ++c) {
        double expected = 0;
        for (int i = 0; i < 4; ++i) expected += weights.weight[i] * controls[2 * (weights.first + i) + c];
        // Four products and three sums of numbers below 1, each rounded: at most 7 units of 2^-24.
        EXPECT_NEAR(one[2 * m + c], expected, 7 * 0x1p-24);
      }
    }
  }
}

TEST(Bank, AModelWithoutAnOutlineHasNoPolyline) {
  Model model = flame_model();
  model.view = PlainView{};
  EXPECT_EQ(bank_of(model, {}).polyline_points(), 0);
}

// Making.

TEST(Bank, LivesInTheMemoryThatItIsGivenAndStaysInsideIt) {
  for (int capacity : {1, 7, 8, 9, 100}) {
    const BankOptions wanted{.capacity = capacity};
    const std::size_t bytes = *bank_bytes(flame_model(), wanted);
    for (std::size_t misaligned : {0, 1, 8, 63}) {
      std::vector<std::byte> memory(bytes + 256, std::byte{0xA5});
      BankOptions options = wanted;
      options.memory = std::span(memory).subspan(misaligned, bytes);
      Bank bank = bank_of(flame_model(), options), elsewhere = bank_of(flame_model(), wanted);
      for (int k = 0; k < capacity; ++k) {
        bank.spawn();
        elsewhere.spawn();
      }
      for (int k = 0; k < 10; ++k) {
        bank.step();
        elsewhere.step();
      }
      EXPECT_EQ(all_outputs(bank), all_outputs(elsewhere));
      EXPECT_THAT(std::span(memory).first(misaligned), Each(std::byte{0xA5}));
      EXPECT_THAT(std::span(memory).subspan(misaligned + bytes), Each(std::byte{0xA5}));
    }
  }
}

TEST(Bank, BadOptionsAreNamed) {
  const auto message = [](const BankOptions& options) {
    auto bank = Bank::create(flame_model(), options);
    return bank ? std::string() : bank.error().message;
  };
  EXPECT_THAT(message({.capacity = 0}), HasSubstr("capacity is 0, expected 1 to 1048576"));
  EXPECT_THAT(message({.capacity = 2'000'000}), HasSubstr("capacity is 2000000"));
  EXPECT_THAT(message({.polyline_points = 1}), HasSubstr("polyline has 1 points, expected 2 to 4096"));
  std::vector<std::byte> memory(100);
  EXPECT_THAT(message({.memory = memory}), HasSubstr("given 100 bytes, expected at least"));
}

TEST(Bank, ABadModelMakesNoBank) {
  Model model = flame_model();
  std::get<ArxModel>(model.dynamics).theta[3].pop_back();
  EXPECT_FALSE(Bank::create(model));
  EXPECT_FALSE(bank_bytes(model, {}));
  Model huge = flame_model();
  huge.outputs[2].highest = 1e15;
  EXPECT_THAT(Bank::create(huge).error().message, HasSubstr("output p1.x"));
  Model tiny = flame_model();
  tiny.inputs[0] = {"wind", "", 0, 1e-20, InputShape::kLinear};
  EXPECT_THAT(Bank::create(tiny).error().message, HasSubstr("input wind has a range narrower than 1e-12"));
  Model steep = flame_model();
  std::get<ArxModel>(steep.dynamics).theta[0].back() = 1e35;
  EXPECT_THAT(Bank::create(steep).error().message, HasSubstr("expected less than 1e30"));
}

TEST(Bank, MovesAsAValue) {
  Bank bank = bank_of(flame_model(), {});
  const InstanceId id = bank.spawn();
  Bank moved = std::move(bank);
  moved.step();
  EXPECT_TRUE(moved.valid(id));
  moved = bank_of(sample_model(), {});
  EXPECT_EQ(moved.output_count(), 8);
}

}  // namespace
}  // namespace wisp::bank_test
