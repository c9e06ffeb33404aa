#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "model/sample_model.hpp"
#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"

namespace wisp {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr float kHuge = 1e30f;

const std::vector<float> kHostile = {kNone, kInfinity, -kInfinity, kHuge, -kHuge, 1e-40f, -1e-40f, -0.0f, 3.4e38f};

// Outputs must be numbers inside the seen range and half of it on either side.
void expect_in_range(const Bank& bank, const Model& model, int step) {
  std::vector<float> values(static_cast<std::size_t>(bank.slots()) * bank.output_count());
  bank.outputs(values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Output& output = model.outputs[i % model.outputs.size()];
    const double room = 0.5 * (output.highest - output.lowest);
    const auto low = static_cast<float>(output.lowest - room), high = static_cast<float>(output.highest + room);
    ASSERT_TRUE(values[i] >= low && values[i] <= high) << output.name << " is " << values[i] << " at step " << step;
  }
}

void live_through(const Model& model, float noise, int steps) {
  auto bank = Bank::create(model, {.capacity = 1});
  ASSERT_TRUE(bank);
  const InstanceId id = bank->spawn();
  bank->set_noise(noise);
  for (int step = 0; step < steps; ++step) {
    const float input = kHostile[static_cast<std::size_t>(step / (1 + step % 7)) % kHostile.size()];
    ASSERT_TRUE(bank->set_inputs(id, std::span(&input, 1)));
    bank->step();
    expect_in_range(*bank, model, step);
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(HostileInput, AMillionStepsNeverLeaveTheRange) { live_through(flame_model(), 1, 1'000'000); }

TEST(HostileInput, NeitherDoStepsWithSignedWindAndTheLoudestNoise) {
  live_through(flame_model({.wind = InputShape::kSplitSign, .noise_rank = 2}), 10, 100'000);
  live_through(sample_model(), 10, 100'000);
}

TEST(HostileInput, StepsWithACurveOnTheWindStayInTheRange) {
  live_through(flame_model({.wind = InputShape::kSplitSignCurve}), 1, 100'000);
  live_through(flame_model({.wind = InputShape::kCurve}), 1, 100'000);
}

TEST(HostileInput, EachKindHeldForLongEndsInTheRange) {
  for (float input : kHostile) {
    auto bank = Bank::create(flame_model({.wind = InputShape::kSplitSign}), {.capacity = 1});
    ASSERT_TRUE(bank);
    bank->spawn();
    for (int step = 0; step < 1000; ++step) {
      bank->set_common_inputs(std::span(&input, 1));
      bank->advance(std::chrono::nanoseconds(16'000'000));
      expect_in_range(*bank, flame_model(), step);
    }
  }
}

TEST(HostileInput, WhatIsNotANumberCountsAsNoWind) {
  auto bank = Bank::create(flame_model({.wind = InputShape::kSplitSign}), {.capacity = 2});
  ASSERT_TRUE(bank);
  bank->spawn(0);
  bank->spawn(0);
  std::vector<float> values(2 * bank->output_count());
  for (int step = 0; step < 100; ++step) {
    bank->set_inputs(std::vector<float>{0.0f, kNone});
    bank->step();
    bank->outputs(values);
    for (int i = 0; i < bank->output_count(); ++i) ASSERT_EQ(values[i], values[bank->output_count() + i]);
  }
}

TEST(HostileInput, WindBeyondTheTrainedRangeCountsAsItsEndAndHalfOfTheRange) {
  auto bank = Bank::create(flame_model(), {.capacity = 3});  // trained on 0 to 1
  ASSERT_TRUE(bank);
  for (int k = 0; k < 3; ++k) bank->spawn(0);
  bank->set_inputs(std::vector<float>{1.5f, kHuge, kInfinity});
  bank->step();
  std::vector<float> values(3 * bank->output_count());
  bank->outputs(values);
  for (int i = 0; i < bank->output_count(); ++i) {
    EXPECT_EQ(values[i], values[bank->output_count() + i]);
    EXPECT_EQ(values[i], values[2 * bank->output_count() + i]);
  }
}

// A model whose noise alone drives it out of the range it was seen in: every such frame is held, and counted.
TEST(HostileInput, HeldFramesAreCounted) {
  Model model = flame_model();
  for (Output& output : model.outputs) {
    const double middle = 0.5 * (output.lowest + output.highest);
    output.lowest = middle - 1e-4;
    output.highest = middle + 1e-4;
  }
  auto bank = Bank::create(model, {.capacity = 10});
  ASSERT_TRUE(bank);
  for (int k = 0; k < 3; ++k) bank->spawn();
  for (int step = 0; step < 100; ++step) bank->step();
  EXPECT_EQ(bank->held().steps, 300U);
  EXPECT_GT(bank->held().held, 290U);
  EXPECT_LE(bank->held().held, 300U);
  auto calm = Bank::create(flame_model(), {.capacity = 1});
  ASSERT_TRUE(calm);
  calm->spawn();
  for (int step = 0; step < 100'000; ++step) calm->step();
  EXPECT_EQ(calm->held().held, 0U);
}

}  // namespace
}  // namespace wisp
