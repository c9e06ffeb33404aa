// Banks of switched ARX models: the equations in double precision, the chain's frequencies, and run's promises.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/sample_switched.hpp"
#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/cost.hpp"

namespace wisp::switched_test {
namespace {

const SwitchedArxModel& switched(const Model& model) { return std::get<SwitchedArxModel>(model.dynamics); }

Bank bank_of(const Model& model, int instances) {
  auto bank = Bank::create(model, {.capacity = instances, .seed = 3});
  EXPECT_TRUE(bank) << bank.error().message;
  for (int k = 0; k < instances; ++k) bank->spawn();
  return std::move(bank).value();
}

float input_at(int step, int instance) { return static_cast<float>(2.2 * std::sin(0.3 * step + instance)) + 0.5f; }

// `lag` steps before the newest, 0 before the first.
double past(const std::vector<double>& samples, int lag) {
  const auto back = static_cast<std::size_t>(lag);
  return back < samples.size() ? samples[samples.size() - 1 - back] : 0.0;
}

// y and u as deviations, newest last; the inputs of the step are there already, its outputs are not.
double next_of(const SwitchedArxModel& model, int mode, int i, const std::vector<std::vector<double>>& y,
               const std::vector<double>& u) {
  const ArxModel arx = mode_model(model, static_cast<std::size_t>(mode));
  double sum = arx.constant[i];
  for (int j = 0; j < 2; ++j) {
    const auto a = arx.a(i, j);
    for (int l = 0; l < static_cast<int>(a.size()); ++l) sum -= a[l] * past(y[j], l);
  }
  const auto b = arx.b(i, 0);
  for (int l = 0; l < static_cast<int>(b.size()); ++l) sum += b[l] * past(u, arx.orders.nk(i, 0) + l);
  return sum;
}

TEST(SwitchedBank, EveryModeStepsAsTheEquationsSay) {
  Model model = sample_switched();
  for (ArxMode& mode : std::get<SwitchedArxModel>(model.dynamics).modes) mode.shock.assign(4, 0.0);
  const SwitchedArxModel& dynamics = switched(model);
  Bank bank = bank_of(model, 1);
  std::vector<std::vector<double>> y(2);
  std::vector<double> u;
  std::vector<int> seen(3, 0);
  for (int step = 0; step < 300; ++step) {
    const float input = input_at(step, 0);
    bank.set_inputs(bank.at(0), std::span(&input, 1));
    bank.step();
    u.push_back(std::clamp<double>(input, -2.5, 3.5) - dynamics.input_mean[0]);
    const int mode = *bank.mode(bank.at(0));
    ++seen[mode];
    const double next[] = {next_of(dynamics, mode, 0, y, u), next_of(dynamics, mode, 1, y, u)};
    float shown[2];
    bank.outputs(bank.at(0), shown);
    for (int i = 0; i < 2; ++i) {
      y[i].push_back(next[i]);
      ASSERT_NEAR(shown[i], dynamics.output_mean[i] + next[i], 1e-5) << step;
    }
  }
  EXPECT_GT(*std::min_element(seen.begin(), seen.end()), 2);  // all of them acted
}

TEST(SwitchedBank, AMarkovChainVisitsModesAsOftenAsItsProbabilitiesSay) {
  const Model model = sample_switched();
  constexpr int kInstances = 40, kSteps = 2000;
  Bank bank = bank_of(model, kInstances);
  std::vector<int> first(3, 0), from(3, 0), counts(9, 0);
  std::vector<int> before(kInstances, -1);
  for (int step = 0; step < kSteps; ++step) {
    bank.step();
    for (int k = 0; k < kInstances; ++k) {
      const int mode = *bank.mode(bank.at(k));
      before[k] < 0 ? ++first[mode] : (++from[before[k]], ++counts[before[k] * 3 + mode]);
      before[k] = mode;
    }
  }
  EXPECT_EQ(first[0], 0);  // its probability is 0
  EXPECT_GT(first[1], 8);
  EXPECT_GT(first[2], 8);
  const auto& expected = switched(model).transitions;
  for (int k = 0; k < 9; ++k) {
    const double share = static_cast<double>(counts[k]) / from[k / 3];
    const double sd = std::sqrt(expected[k] * (1 - expected[k]) / from[k / 3]);
    EXPECT_NEAR(share, expected[k], 4 * sd) << k;
  }
}

TEST(SwitchedBank, WithoutNoiseAMarkovChainTakesTheLikeliestStep) {
  Bank bank = bank_of(sample_switched(), 2);
  bank.set_noise(0);
  EXPECT_FALSE(bank.mode(bank.at(0)));
  for (int step = 0; step < 50; ++step) {
    bank.step();
    ASSERT_EQ(bank.mode(bank.at(0)), 1);
  }
}

TEST(SwitchedBank, TheLikeliestStepMayBeAnyOfThree) {
  Model model = sample_switched();
  std::get<SwitchedArxModel>(model.dynamics).initial = {0.25, 0.3, 0.45};
  std::get<SwitchedArxModel>(model.dynamics).transitions = {0.3, 0.5, 0.2, 0.6, 0.25, 0.15, 0.2, 0.35, 0.45};
  Bank bank = bank_of(model, 1);
  bank.set_noise(0);
  bank.step();
  EXPECT_EQ(bank.mode(bank.at(0)), 2);
  model = sample_switched();
  std::get<SwitchedArxModel>(model.dynamics).initial = {1, 0, 0};
  std::get<SwitchedArxModel>(model.dynamics).transitions = {0.3, 0.5, 0.2, 0.6, 0.25, 0.15, 0.2, 0.35, 0.45};
  bank = bank_of(model, 1);
  bank.set_noise(0);
  for (const int mode : {0, 1, 0, 1}) {
    bank.step();
    EXPECT_EQ(bank.mode(bank.at(0)), mode);
  }
}

TEST(SwitchedBank, ResidualsHaveTheCovarianceOfTheirMode) {
  Model model = sample_switched();
  auto& dynamics = std::get<SwitchedArxModel>(model.dynamics);
  dynamics.orders.na = OrderMatrix(2, 2);
  for (ArxMode& mode : dynamics.modes) {
    mode.theta = {{0, 0}, {0, 0}};
    mode.std_error.clear();
    mode.constant = {0, 0};
  }
  dynamics.modes[2].shock = {0.2, 0, -0.1, 0.05};
  Bank bank = bank_of(model, 1);
  double rows = 0, xx = 0, xy = 0, yy = 0;
  for (int step = 0; step < 20'000; ++step) {
    bank.step();
    if (bank.mode(bank.at(0)) != 2) continue;
    float y[2];
    bank.outputs(bank.at(0), y);
    const double e[] = {y[0] - 0.25, y[1] + 0.5};
    ++rows, xx += e[0] * e[0], xy += e[0] * e[1], yy += e[1] * e[1];
  }
  EXPECT_NEAR(xx / rows, 0.04, 0.002);
  EXPECT_NEAR(xy / rows, -0.02, 0.001);
  EXPECT_NEAR(yy / rows, 0.0125, 0.0006);
}

TEST(SwitchedBank, AnInstancePlaysTheSameAloneAndAmongOthersAndAfterBeingRestored) {
  const Model model = sample_switched();
  Bank alone = bank_of(model, 0 + 1), many = bank_of(model, 13);
  std::vector<std::byte> saved(many.save_bytes());
  alone.end(alone.at(0));
  const InstanceId one = alone.spawn(11);  // the twelfth's random stream
  for (int step = 0; step < 200; ++step) {
    for (int k = 0; k < 13; ++k) {
      const float input = input_at(step, k);
      many.set_inputs(many.at(k), std::span(&input, 1));
      if (k == 11) alone.set_inputs(one, std::span(&input, 1));
    }
    alone.step();
    many.step();
    if (step % 50 == 20) {
      many.save(saved);
      many.step();
      ASSERT_TRUE(many.restore(saved));
    }
    float a[2], b[2];
    alone.outputs(one, a);
    many.outputs(many.at(11), b);
    ASSERT_EQ(a[0], b[0]) << step;
    ASSERT_EQ(a[1], b[1]) << step;
    ASSERT_EQ(alone.mode(one), many.mode(many.at(11)));
  }
}

// Five and four coefficients of one mode.
TEST(SwitchedBank, CostsOneModeAndAWord) {
  const auto cost = count_operations(sample_switched(), 0);
  ASSERT_TRUE(cost);
  EXPECT_EQ(cost->multiply_adds_per_frame, 9);
  // The input: −; coefficients: × +; whether each output was clamped: or.
  EXPECT_EQ(cost->dynamics_operations, 1 + 9 * 2 + 2);
  // Two deviates, one for each output, and three shocks of them: × +.
  EXPECT_EQ(cost->noise_operations, 33 + 3 * 2);
  EXPECT_EQ(cost->random_operations, 2 * (1 + 7 * 6) + 9);  // words of the shocks, and one for the chain
}

TEST(SwitchedBank, ASingleModeHasTheBitsOfItsArxModel) {
  const Model arx = flame_model({.wind = InputShape::kEvenOdd});
  Model single = arx;
  single.dynamics = switched_of(std::get<ArxModel>(arx.dynamics));
  Bank a = bank_of(arx, 9), b = bank_of(single, 9);
  std::vector<float> wind(9), from_a(9 * 16), from_b(9 * 16);
  for (int step = 0; step < 300; ++step) {
    for (int k = 0; k < 9; ++k) wind[static_cast<std::size_t>(k)] = input_at(step, k) - 0.5f;
    for (Bank* bank : {&a, &b}) {
      bank->set_inputs(wind);
      bank->step();
    }
    a.outputs(from_a);
    b.outputs(from_b);
    ASSERT_EQ(from_a, from_b) << step;
  }
}

TEST(SwitchedBank, ManyStepsOfOneOutputKnowTheirMode) {
  Model filter;
  filter.rate_hz = 30;
  filter.outputs = {{"y", "", -1, 1}};
  ArxModel arx;
  arx.orders = {OrderMatrix(1, 1, 2), OrderMatrix(1, 0), OrderMatrix(1, 0)};
  arx.theta = {{-1.2, 0.5}};
  arx.constant = arx.output_mean = {0};
  arx.noise.sd = {0.1};
  filter.dynamics = switched_of(arx);
  Bank bank = bank_of(filter, 1);
  bank.step(20);
  EXPECT_EQ(bank.mode(bank.at(0)), 0);
}

}  // namespace
}  // namespace wisp::switched_test
