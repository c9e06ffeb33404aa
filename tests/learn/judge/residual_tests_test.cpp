#include "learn/judge/residual_tests.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "learn/judge/judged_fit.hpp"
#include "learn/rows/arx_design.hpp"

namespace wisp::residual_tests_test {
namespace {

struct Truth {
  double a1 = -1.2;
  double a2 = 0.5;
  double c = 0;   // colour of the noise: e(t) + c e(t−1)
  double b3 = 0;  // a late effect of the input
};

Recording simulate(const Truth& truth, std::size_t rows, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::vector<double> u(rows), y(rows), e(rows);
  double input = 0;
  for (std::size_t t = 0; t < rows; ++t) {
    input = 0.6 * input + normal(generator);  // coloured
    u[t] = input;
    e[t] = 0.5 * normal(generator);
    y[t] = e[t] + (t > 0 ? truth.c * e[t - 1] : 0);
    if (t >= 3) y[t] += -truth.a1 * y[t - 1] - truth.a2 * y[t - 2] + u[t - 1] + 0.3 * u[t - 2] + truth.b3 * u[t - 3];
  }
  Recording recording;
  recording.rate_hz = 1;
  recording.channels = {{"u", "", Role::kInput, u}, {"y", "", Role::kOutput, y}};
  return recording;
}

ResidualTests tests_of(const Truth& truth, unsigned seed, std::size_t rows = 2000) {
  const Recording recording = simulate(truth, rows, seed);
  ArxOptions options;
  options.orders = make_orders({.outputs = 1, .inputs = 1, .na = 2, .nb = 2, .nk = 1});
  const auto fit = fit_arx({&recording, 1}, {{"u"}, {"y"}}, options);
  EXPECT_TRUE(fit);
  const auto tests = test_residuals(fit->model, {&recording, 1}, {{"u"}, {"y"}}, {.learned_from_it = true});
  EXPECT_TRUE(tests) << tests.error().message;
  return *tests;
}

TEST(ResidualTests, RejectTheTrueModelAsOftenAsTheyClaim) {
  int coloured = 0;
  int dependent = 0;
  constexpr int kRuns = 400;
  for (unsigned run = 0; run < kRuns; ++run) {
    const ResidualTests tests = tests_of({}, 100 + run, 1000);
    coloured += tests.whiteness[0].p < 0.05;
    dependent += tests.independence[0][0].p < 0.05;
  }
  // 20 of 400 are expected, with a standard deviation of 4.4; fixed seeds.
  EXPECT_NEAR(coloured, 20, 14);
  EXPECT_NEAR(dependent, 20, 16);
}

TEST(ResidualTests, SeeColouredNoise) {
  const ResidualTests tests = tests_of({.c = 0.4}, 1);
  EXPECT_LT(tests.whiteness[0].p, 1e-6);
  EXPECT_GT(std::abs(tests.whiteness[0].correlation[0]), tests.whiteness[0].bound);
}

TEST(ResidualTests, SeeAMissingInputLag) {
  const ResidualTests tests = tests_of({.b3 = 0.2}, 2);
  EXPECT_LT(tests.independence[0][0].p, 1e-6);
}

TEST(ResidualTests, FindTheCorrelationsOfAKnownSeries) {
  Recording recording;
  recording.rate_hz = 1;
  recording.channels = {{"y", "", Role::kOutput, {}}};
  for (int t = 0; t < 400; ++t) recording.channels[0].samples.push_back(t % 2 ? -1 : 1);
  ArxModel model;
  model.orders = make_orders({.outputs = 1, .inputs = 0, .na = 0, .nb = 0, .nk = 0});
  model.theta = {{}};
  model.constant = {0};
  model.output_mean = {0};
  model.noise.sd = {1};
  const auto tests = test_residuals(model, {&recording, 1}, {{}, {"y"}}, {.lags = 3});
  ASSERT_TRUE(tests);
  EXPECT_NEAR(tests->whiteness[0].correlation[0], -399.0 / 400, 1e-12);
  EXPECT_NEAR(tests->whiteness[0].correlation[1], 398.0 / 400, 1e-12);
  EXPECT_NEAR(tests->whiteness[0].p, 0, 1e-12);
}

TEST(ResidualTests, AMissingInputCountsAsItsMeanAtAnyLevel) {
  const auto correlation = [](double level) {
    Recording recording = simulate({}, 500, 4);
    for (double& u : recording.channels[0].samples) u += level;
    recording.channels[0].samples[250] = std::numeric_limits<double>::quiet_NaN();
    ArxOptions options;
    options.orders = make_orders({.outputs = 1, .inputs = 1, .na = 2, .nb = 2, .nk = 1});
    const auto fit = fit_arx({&recording, 1}, {{"u"}, {"y"}}, options);
    EXPECT_TRUE(fit);
    return test_residuals(fit->model, {&recording, 1}, {{"u"}, {"y"}}, {.lags = 5})->independence[0][0].correlation;
  };
  const auto at_zero = correlation(0), far = correlation(1000);
  ASSERT_EQ(at_zero.size(), far.size());
  for (std::size_t lag = 0; lag < far.size(); ++lag) EXPECT_NEAR(at_zero[lag], far[lag], 1e-9) << lag;
}

TEST(ResidualTests, NeedRowsEnough) {
  const Recording recording = simulate({}, 60, 3);
  ArxModel model;
  model.orders = make_orders({.outputs = 1, .inputs = 1, .na = 1, .nb = 1, .nk = 1});
  model.theta = {{-0.5, 1}};
  model.constant = {0};
  model.output_mean = {0};
  model.input_mean = {0};
  const auto tests = test_residuals(model, {&recording, 1}, {{"u"}, {"y"}});
  ASSERT_FALSE(tests);
  EXPECT_NE(tests.error().message.find("59 rows"), std::string::npos);
}

}  // namespace
}  // namespace wisp::residual_tests_test
