// Many steps of a lone instance of one output are made side by side: those that single steps make, to the bit.

#include "run/arx/time_lanes.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "run/bank/bits_of.hpp"
#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::time_lanes_test {
namespace {

bool is_there(const Model& model) {
  Arena measured;
  const auto& arx = std::get<ArxModel>(model.dynamics);
  return TimeLanes<LiveNumbers>(make_arx_program(model, arx, measured), measured).there();
}

constexpr InputShape kShapes[] = {InputShape::kLinear, InputShape::kEvenOdd};

// Orders, delays, gaps among the lags, inputs' shapes and shared shocks by chance; outputs that are often clamped.
Model filter_of_chance(unsigned seed, bool vector = false) {
  std::mt19937 random(seed);
  const auto below = [&](int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); };
  Model model;
  model.rate_hz = 50;
  model.outputs = {{"y", "", -0.2, 0.15}};
  for (int inputs = below(3); inputs >= 0; --inputs) {
    const InputShape shape = kShapes[below(2)];
    model.inputs.push_back({"u" + std::to_string(inputs), "", has_powers(shape) ? -1.0 : 0.0, 1.0, shape});
  }
  if (vector)
    model.inputs = {{"wind.x", "", -1, 1, InputShape::kWindAlong}, {"wind.z", "", -1, 1, InputShape::kWindAcross}};
  const auto regressors = static_cast<int>(regressor_count(model.inputs));
  ArxModel arx;
  arx.orders = {OrderMatrix(1, 1, below(7)), OrderMatrix(1, regressors), OrderMatrix(1, regressors)};
  arx.theta = {{}};
  const auto add = [&](double size) { arx.theta[0].push_back(below(4) == 0 ? 0 : size * (below(200) - 100) / 100); };
  for (int lag = 0; lag < arx.orders.na(0, 0); ++lag) add(0.16);
  for (int k = 0; k < regressors; ++k) {
    arx.orders.nb(0, k) = below(6);
    arx.orders.nk(0, k) = below(4);
    for (int lag = 0; lag < arx.orders.nb(0, k); ++lag) add(0.1);
  }
  arx.constant = {0.01};
  arx.output_mean = {-0.01};
  arx.input_mean.assign(regressors, vector ? 0 : 0.1 * below(2));
  arx.noise.sd = {below(4) == 0 ? 0 : 0.05};
  model.dynamics = arx;
  return model;
}

Bank lone(const Model& model, int capacity = 1) {
  auto bank = Bank::create(model, {.capacity = capacity, .seed = 7});
  EXPECT_TRUE(bank) << bank.error().message;
  bank->spawn(11);
  return std::move(bank).value();
}

std::vector<float> inputs_for(const Bank& bank, int steps) {
  std::vector<float> values(static_cast<std::size_t>(steps) * bank.slots() * bank.input_count());
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = 0.1f * static_cast<float>(k * 7 % 31) - 1.2f;
  return values;
}

// As step(count, inputs, outputs), one by one; `inputs` may be empty.
std::vector<float> single_steps(Bank& bank, int count, std::span<const float> inputs) {
  std::vector<float> all(static_cast<std::size_t>(count) * bank.slots());
  const std::size_t row = inputs.size() / count;
  for (int step = 0; step < count; ++step) {
    if (row > 0) bank.set_inputs(inputs.subspan(step * row, row));
    bank.step();
    bank.outputs(std::span(all).subspan(static_cast<std::size_t>(step) * bank.slots(), bank.slots()));
  }
  return all;
}

TEST(TimeLanes, AreThereForOneOutputThatPlaysNoRecordedResiduals) {
  EXPECT_TRUE(is_there(filter_of_chance(1)));
  EXPECT_FALSE(is_there(flame_model()));
  Model resampled = filter_of_chance(1);
  std::get<ArxModel>(resampled.dynamics).noise.resampled = resampled_flame_residuals(1, 60, false);
  EXPECT_FALSE(is_there(resampled));
}

TEST(TimeLanes, ManyStepsAreAsManySingleOnes) {
  std::uint64_t clamped = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    Bank bank = lone(filter_of_chance(seed)), expected = lone(filter_of_chance(seed));
    for (int count : {2, 1, 7, 8, 64, 65, 3, 131}) {
      const auto inputs = inputs_for(bank, count);
      const auto outputs = single_steps(expected, count, inputs);
      std::vector<float> at_once(outputs.size());
      bank.step(count, inputs, at_once);
      EXPECT_TRUE(same_bits(at_once, outputs)) << seed << ", " << count << " steps";
      EXPECT_EQ(saved(bank), saved(expected)) << seed << ", " << count << " steps";
      EXPECT_EQ(bank.clamped().clamped, expected.clamped().clamped) << seed << ", " << count << " steps";
    }
    clamped += bank.clamped().clamped;
  }
  EXPECT_GT(clamped, 100U);
}

TEST(TimeLanes, ManyStepsInAWindFromAnySideAreAsManySingleOnes) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Model model = filter_of_chance(seed, true);
    Bank bank = lone(model), expected = lone(model);
    const auto inputs = inputs_for(bank, 9);
    std::vector<float> at_once(9);
    bank.step(9, inputs, at_once);
    EXPECT_TRUE(same_bits(at_once, single_steps(expected, 9, inputs))) << seed;
  }
}

TEST(TimeLanes, WithoutNoiseToo) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Bank bank = lone(filter_of_chance(seed)), expected = lone(filter_of_chance(seed));
    for (Bank* one : {&bank, &expected}) one->set_noise(0);
    const auto inputs = inputs_for(bank, 100);
    std::vector<float> at_once(100);
    bank.step(100, inputs, at_once);
    EXPECT_TRUE(same_bits(at_once, single_steps(expected, 100, inputs))) << seed;
  }
}

TEST(TimeLanes, WithoutInputsWhatWasSetActs) {
  Bank bank = lone(filter_of_chance(2)), expected = lone(filter_of_chance(2));
  for (Bank* one : {&bank, &expected}) one->set_common_inputs(std::vector<float>(bank.input_count(), 0.6f));
  bank.step(77);
  const auto outputs = single_steps(expected, 77, {});
  std::vector<float> last(1);
  bank.outputs(last);
  EXPECT_EQ(last[0], outputs.back());
  EXPECT_EQ(saved(bank), saved(expected));
}

TEST(TimeLanes, ALongFrameShowsWhatLiesBetweenItsLastSteps) {
  Bank bank = lone(filter_of_chance(3)), expected = lone(filter_of_chance(3));
  bank.advance(9 * bank.step_time() / 2);
  for (int k = 0; k < 3; ++k) expected.advance(3 * expected.step_time() / 2);
  std::vector<float> shown(1), last(1);
  bank.outputs(shown);
  expected.outputs(last);
  EXPECT_EQ(shown, last);
  EXPECT_EQ(saved(bank), saved(expected));
}

TEST(TimeLanes, AWindThatTurnedMeanwhileIsRememberedAfterwards) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Bank bank = lone(filter_of_chance(seed)), expected = lone(filter_of_chance(seed));
    for (float wind : {0.5f, -0.5f, 0.5f}) {  // the second alone in many steps at once
      const std::vector<float> inputs(static_cast<std::size_t>(20) * bank.input_count(), wind);
      const auto outputs = single_steps(expected, 20, inputs);
      std::vector<float> made(20);
      wind < 0 ? bank.step(20, inputs, made) : static_cast<void>(made = single_steps(bank, 20, inputs));
      EXPECT_TRUE(same_bits(made, outputs)) << seed << ", wind " << wind;
    }
  }
}

TEST(TimeLanes, CompanyThatComesAndGoesChangesNothing) {
  const Model model = filter_of_chance(4);
  Bank bank = lone(model, 9), expected = lone(model, 9);
  std::vector<float> at_once, outputs;
  for (int turn = 0; turn < 4; ++turn) {
    for (Bank* one : {&bank, &expected}) {
      turn % 2 == 1 ? static_cast<void>(one->spawn(20)) : static_cast<void>(one->end(one->at(1)));
    }
    const auto inputs = inputs_for(bank, 50);
    outputs = single_steps(expected, 50, inputs);
    at_once.resize(outputs.size());
    bank.step(50, inputs, at_once);
    EXPECT_TRUE(same_bits(at_once, outputs)) << turn;
  }
}

}  // namespace
}  // namespace wisp::time_lanes_test
