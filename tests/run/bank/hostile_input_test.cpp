#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "model/sample_chain.hpp"
#include "model/sample_model.hpp"
#include "model/sample_switched.hpp"
#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::hostile_input_test {
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
    auto low = static_cast<float>(output.lowest - room), high = static_cast<float>(output.highest + room);
    // What is out shrinks to nothing; what falls is clamped to a million metres, and comes to rest as far beyond.
    if (model.extinction) std::tie(low, high) = std::pair(std::min(low, 0.0f), std::max(high, 0.0f));
    if (std::holds_alternative<ChainModel>(model.dynamics)) std::tie(low, high) = std::pair(-2.1e6f, 2.1e6f);
    ASSERT_TRUE(values[i] >= low && values[i] <= high) << output.name << " is " << values[i] << " at step " << step;
  }
}

// Steps in all that take hostile input; script/verify asks for more of them.
std::int64_t hostile_steps() {
  const char* asked = std::getenv("WISP_HOSTILE_STEPS");
  return asked ? std::atoll(asked) : 10'000'000;
}

void live_through(const Model& model, float noise, std::int64_t steps) {
  constexpr int kInstances = 64;
  auto bank = Bank::create(model, {.capacity = kInstances});
  ASSERT_TRUE(bank) << bank.error().message;
  for (int k = 0; k < kInstances; ++k) bank->spawn();
  bank->set_noise(noise);
  std::vector<float> inputs(kInstances * model.inputs.size());
  const std::int64_t frames = steps / kInstances + 1;
  for (std::int64_t frame = 0; frame < frames; ++frame) {
    for (std::size_t k = 0; k < inputs.size(); ++k) {  // every instance hears the kinds in a rhythm of its own
      const auto beat = static_cast<std::size_t>(frame) / (1 + (k + static_cast<std::size_t>(frame)) % 7);
      inputs[k] = kHostile[(beat + k) % kHostile.size()];
    }
    bank->set_inputs(inputs);
    bank->step();
    expect_in_range(*bank, model, static_cast<int>(frame));
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(HostileInput, TenMillionStepsOfEveryKindNeverLeaveTheRange) {
  const std::vector<std::pair<Model, float>> kinds = {{flame_model(), 1.0f},
                                                      {flame_model({.wind = InputShape::kEvenOdd}), 10.0f},
                                                      {flame_model({.wind = InputShape::kEvenOdd}), 1.0f},
                                                      {default_flame_model(), 1.0f},
                                                      {coupled_flame_model(), 10.0f},
                                                      {sample_model(), 10.0f},
                                                      {sample_switched(), 10.0f},
                                                      {windy_chain(), 1.0f}};
  for (const auto& [model, noise] : kinds) {
    SCOPED_TRACE(model.name);
    live_through(model, noise, hostile_steps() / static_cast<std::int64_t>(kinds.size()));
  }
}

TEST(HostileInput, EachKindHeldForLongEndsInTheRange) {
  for (float input : kHostile) {
    auto bank = Bank::create(flame_model({.wind = InputShape::kEvenOdd}), {.capacity = 1});
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
  auto bank = Bank::create(flame_model({.wind = InputShape::kEvenOdd}), {.capacity = 2});
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

// A model whose noise alone drives it out of the range it was seen in: every such frame is clamped, and counted.
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
  EXPECT_EQ(bank->clamped().steps, 300U);
  EXPECT_GT(bank->clamped().clamped, 290U);
  EXPECT_LE(bank->clamped().clamped, 300U);
  auto calm = Bank::create(flame_model(), {.capacity = 1});
  ASSERT_TRUE(calm);
  calm->spawn();
  for (int step = 0; step < 100'000; ++step) calm->step();
  EXPECT_EQ(calm->clamped().clamped, 0U);
}

}  // namespace
}  // namespace wisp::hostile_input_test
