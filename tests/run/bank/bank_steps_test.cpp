// Many steps in one call: the bits of as many single ones.

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "model/sample_chain.hpp"
#include "model/sample_switched.hpp"
#include "run/bank/bits_of.hpp"
#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace wisp::bank_steps_test {
namespace {

constexpr int kInstances = 150, kSteps = 37;

// One slot in the middle is empty.
Bank bank_of(const Model& model) {
  auto bank = Bank::create(model, {.capacity = kInstances});
  EXPECT_TRUE(bank) << bank.error().message;
  for (int k = 0; k < kInstances; ++k) bank->spawn();
  bank->end(bank->at(kInstances / 2));
  return std::move(bank).value();
}

std::vector<Model> models() {
  return {flame_model({.wind = InputShape::kEvenOdd}), flame_model(), default_flame_model(), windy_chain(),
          sample_switched()};
}

// Other winds for every instance and step, some of which blow flames out.
std::vector<float> winds_for(const Bank& bank) {
  std::vector<float> winds(static_cast<std::size_t>(kSteps) * bank.slots() * bank.input_count());
  for (std::size_t k = 0; k < winds.size(); ++k) winds[k] = 0.4f * static_cast<float>(k * 7 % 41 % 21) - 4.0f;
  return winds;
}

std::vector<float> single_steps(Bank& bank, const std::vector<float>& winds) {
  std::vector<float> all(static_cast<std::size_t>(kSteps) * bank.slots() * bank.output_count());
  const std::size_t row_in = winds.size() / kSteps, row_out = all.size() / kSteps;
  for (int step = 0; step < kSteps; ++step) {
    bank.set_inputs(std::span(winds).subspan(step * row_in, row_in));
    bank.step();
    bank.outputs(std::span(all).subspan(step * row_out, row_out));
  }
  return all;
}

void run_threads(void*, int parts, void (*task)(void* of, int part), void* of) {
  std::vector<std::thread> threads;
  for (int part = 0; part < parts; ++part) threads.emplace_back(task, of, part);
  for (std::thread& thread : threads) thread.join();
}

TEST(BankSteps, ManyInOneCallAreAsManySingleOnes) {
  for (const Model& model : models()) {
    for (int parts : {1, 2}) {
      Bank bank = bank_of(model), expected = bank_of(model);
      bank.set_crew({parts, run_threads, nullptr});
      const auto winds = winds_for(bank);
      const auto outputs = single_steps(expected, winds);
      std::vector<float> at_once(outputs.size());
      bank.step(kSteps, winds, at_once);
      EXPECT_TRUE(same_bits(at_once, outputs)) << model.name << ", " << parts << " parts";
      EXPECT_EQ(saved(bank), saved(expected)) << model.name << ", " << parts << " parts";
    }
  }
}

TEST(BankSteps, WithoutInputsWhatWasSetActs) {
  Bank bank = bank_of(models()[0]), expected = bank_of(models()[0]);
  for (Bank* one : {&bank, &expected}) one->set_common_inputs(std::vector<float>{0.7f});
  bank.step(kSteps);
  for (int step = 0; step < kSteps; ++step) expected.step();
  std::vector<float> shown(static_cast<std::size_t>(bank.slots()) * bank.output_count()), last(shown.size());
  bank.outputs(shown);
  expected.outputs(last);
  EXPECT_TRUE(same_bits(shown, last));
  EXPECT_EQ(saved(bank), saved(expected));
}

TEST(BankSteps, NoStepChangesNothing) {
  Bank bank = bank_of(models()[0]);
  bank.advance(bank.step_time() / 3);
  const auto before = saved(bank);
  bank.step(0);
  EXPECT_EQ(saved(bank), before);
}

TEST(BankSteps, AFlameGoesOutAtTheSameStepInALongFrame) {
  Bank bank = bank_of(default_flame_model()), expected = bank_of(default_flame_model());
  for (Bank* one : {&bank, &expected}) one->set_common_inputs(std::vector<float>{4.0f});
  bank.advance(kSteps * bank.step_time());
  for (int step = 0; step < kSteps; ++step) expected.advance(expected.step_time());
  const auto state = bank.extinction()->state_of(bank.at(0)), other = expected.extinction()->state_of(expected.at(0));
  ASSERT_FALSE(state->lit);
  EXPECT_LT(state->since_out, kSteps * bank.step_time());
  EXPECT_EQ(state->since_out, other->since_out);
  EXPECT_EQ(saved(bank), saved(expected));
}

}  // namespace
}  // namespace wisp::bank_steps_test
