// Hammerstein systems: known curves are recovered, and a curve is taken only where free simulation of what is held out
// is surely better by it.

#include "learn/arx/curve/curve_fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "learn/arx/curve/curve_choice.hpp"
#include "learn/arx/fit/arx_fit.hpp"

namespace wisp::curve_fit_test {
namespace {

using testing::HasSubstr;

const ChannelChoice kChannels{{"u"}, {"y"}};
const CurveFitOptions kOptions{.orders = {OrderMatrix(1, 1, 2), OrderMatrix(1, 1, 2), OrderMatrix(1, 1, 1)},
                               .inputs = {{{"u"}, -1, 2}}};
// Between −1 and 2, where it is the input itself: flat, steep, and between.
const std::vector<double> kSteps{-1, -0.8, 1.1, 2};

// −1 to 2 in steps of 0.01, each as often as any other, shuffled: quantiles do not depend on chance.
std::vector<double> shuffled_inputs(std::size_t rows, std::mt19937_64& generator) {
  std::vector<double> u(rows);
  for (std::size_t t = 0; t < rows; ++t) u[t] = -1 + 0.01 * static_cast<double>(t % 301);
  std::shuffle(u.begin(), u.end(), generator);
  return u;
}

// y − 1.5 y₁ + 0.7 y₂ = x₁ + 0.5 x₂ + e with x = curve(u).
Recording made(const InputCurve& curve, std::size_t rows, unsigned seed, double sd = 0.3) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Recording out{.source = "made", .rate_hz = 10};
  std::vector<double> u = shuffled_inputs(rows, generator), y(rows);
  for (std::size_t t = 2; t < rows; ++t) {
    y[t] = 1.5 * y[t - 1] - 0.7 * y[t - 2] + value_at(curve, u[t - 1]) + 0.5 * value_at(curve, u[t - 2]) +
           sd * normal(generator);
  }
  out.channels = {{"u", "", Role::kInput, std::move(u)}, {"y", "", Role::kOutput, std::move(y)}};
  return out;
}

InputCurve true_curve() {
  const Recording any = made({}, 3010, 1);
  return {curve_knots({&any, 1}, kOptions.inputs[0], 4), kSteps};
}

CurveFit fitted(const Recording& recording, const CurveFitOptions& options = kOptions) {
  auto fit = fit_input_curves({&recording, 1}, kChannels, options);
  EXPECT_TRUE(fit) << fit.error().message;
  return *std::move(fit);
}

TEST(CurveFit, KnotsStandAtQuantilesBetweenTheEnds) {
  EXPECT_THAT(true_curve().at, testing::Pointwise(testing::DoubleNear(0.011), {-1, 0, 1, 2}));
}

// Of 200 values 0.54 lie beyond three standard errors by chance; more than 4 do in one of 5000 such tests.
TEST(CurveFit, RecoversAKnownCurveWithinThreeStandardErrors) {
  const InputCurve truth = true_curve();
  int beyond = 0;
  double largest = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    const CurveFit fit = fitted(made(truth, 3010, seed));
    EXPECT_TRUE(fit.converged) << seed;
    ASSERT_EQ(fit.curves[0].curve.at, truth.at);
    for (std::size_t k = 1; k < 3; ++k) {
      beyond += std::abs(fit.curves[0].curve.value[k] - kSteps[k]) > 3 * fit.curves[0].std_error[k] ? 1 : 0;
      largest = std::max(largest, fit.curves[0].std_error[k]);
    }
    EXPECT_NEAR(fit.loss[0], 0.09, 5 * 0.09 * std::sqrt(2.0 / 3008)) << seed;
  }
  EXPECT_LE(beyond, 4);
  EXPECT_LT(largest, 0.05);
}

// Behind the curve the linear half is what it was.
TEST(CurveFit, TheLinearHalfIsRecoveredBehindIt) {
  const Recording recording = made(true_curve(), 3010, 7);
  const std::vector<InputCurve> curves{fitted(recording).curves[0].curve};
  const std::vector<Recording> bent{with_curves(recording, kOptions.inputs, curves)};
  const auto arx = fit_arx(bent, kChannels, {.orders = kOptions.orders});
  ASSERT_TRUE(arx);
  const double truth[] = {-1.5, 0.7, 1, 0.5};
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(arx->model.theta[0][k], truth[k], 4 * arx->model.std_error[0][k]);
}

// Two halves of a recording that no noise disturbs: the estimate is exact but for rounding, whatever the units are.
TEST(CurveFit, IsExactWithoutNoise) {
  InputCurve truth = true_curve();
  Recording recording = made(truth, 602, 3, 0);
  for (double& y : recording.channels[1].samples) y *= 1e9;
  truth.at = curve_knots({&recording, 1}, kOptions.inputs[0], 4);
  const CurveFit fit = fitted(recording);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(fit.curves[0].curve.value[k], kSteps[k], 2e-3) << k;
}

TEST(CurveFit, NeverFalls) {
  // Down, then up: the best that never falls is flat, then up.
  Recording recording = made({}, 3010, 5);
  auto &u = recording.channels[0].samples, &y = recording.channels[1].samples;
  for (std::size_t t = 2; t < y.size(); ++t) {
    y[t] = 0.5 * y[t - 1] + (u[t - 1] < 0.5 ? 0.5 - u[t - 1] : 2 * u[t - 1] - 1);
  }
  const CurveFit fit = fitted(recording);
  const auto& value = fit.curves[0].curve.value;
  EXPECT_TRUE(std::is_sorted(value.begin(), value.end()));
  EXPECT_LT(value[1] - value[0], 0.05);
}

// The sides of a split sign share a curve, outputs share it too, and each has coefficients of its own.
TEST(CurveFit, SidesAndOutputsShareACurve) {
  const InputCurve truth{{0, 0.66, 1.33, 2}, {0, 0.2, 0.9, 2}};
  std::mt19937_64 generator(11);
  std::uniform_real_distribution<double> uniform(-2, 2);
  std::normal_distribution<double> normal;
  constexpr std::size_t kRows = 6000;
  std::vector<double> plus(kRows), minus(kRows), x(kRows), y(kRows);
  for (std::size_t t = 0; t < kRows; ++t) {
    const double u = uniform(generator);
    plus[t] = std::max(u, 0.0);
    minus[t] = std::max(-u, 0.0);
    if (t == 0) continue;
    const double p = value_at(truth, plus[t - 1]), m = value_at(truth, minus[t - 1]);
    x[t] = 0.8 * x[t - 1] + p - m + 0.2 * normal(generator);
    y[t] = 0.6 * y[t - 1] - 0.5 * p - 0.4 * m + 0.1 * normal(generator);
  }
  Recording recording{.source = "made", .rate_hz = 10};
  recording.channels = {{"u+", "", Role::kInput, plus},
                        {"u-", "", Role::kInput, minus},
                        {"x", "", Role::kOutput, x},
                        {"y", "", Role::kOutput, y}};
  ArxOrders orders{OrderMatrix(2, 2), OrderMatrix(2, 2, 1), OrderMatrix(2, 2, 1)};
  orders.na(0, 0) = orders.na(1, 1) = 1;
  const auto fit = fit_input_curves({&recording, 1}, {{"u+", "u-"}, {"x", "y"}},
                                    {.orders = orders, .inputs = {{{"u+", "u-"}, 0, 2}}, .knots = 4});
  ASSERT_TRUE(fit) << fit.error().message;
  ASSERT_EQ(fit->curves.size(), 1U);
  // Quantiles of a uniform input lie within 0.05 of the true knots, and a chord of the curve within a quarter of that
  // times the change of its slope, 1.65, of it.
  for (std::size_t k = 1; k < 3; ++k) {
    const double error = fit->curves[0].curve.value[k] - value_at(truth, fit->curves[0].curve.at[k]);
    EXPECT_NEAR(error, 0, 3 * fit->curves[0].std_error[k] + 0.02) << k;
  }
}

TEST(CurveFit, BadRequestsAreNamed) {
  const Recording recording = made({}, 301, 1);
  const auto error = [&](const CurveFitOptions& options, const ChannelChoice& channels = kChannels) {
    const auto fit = fit_input_curves({&recording, 1}, channels, options);
    return fit ? std::string("no error") : fit.error().message;
  };
  CurveFitOptions options = kOptions;
  options.knots = 2;
  EXPECT_THAT(error(options), HasSubstr("a curve of 2 knots was requested, expected 3 to 16"));
  EXPECT_THAT(error(kOptions, {{"wind"}, {"y"}}), HasSubstr("wind"));
  options = kOptions;
  options.inputs.clear();
  EXPECT_THAT(error(options), HasSubstr("no curve was requested input u"));
  options = kOptions;
  options.orders.nb(0, 0) = 60;
  EXPECT_THAT(error(options), HasSubstr("record longer"));
  Recording two = recording;
  for (double& u : two.channels[0].samples) u = u < 0.5 ? -1 : 2;
  EXPECT_THAT(fit_input_curves({&two, 1}, kChannels, kOptions).error().message, HasSubstr("too few values"));
}

CurveChoice chosen(const Recording& recording, std::optional<int> knots = {}) {
  auto choice = choose_input_curves(arx::folds_of({&recording, 1}), kChannels, kOptions, knots);
  EXPECT_TRUE(choice) << choice.error().message;
  return *std::move(choice);
}

TEST(CurveChoice, ABentInputIsFoundByFreeSimulation) {
  const CurveChoice choice = chosen(made(true_curve(), 3010, 3));
  EXPECT_GE(choice.knots, 4);
  EXPECT_THAT(choice.reason, HasSubstr("inputs are bent by curves of"));
  EXPECT_GT(choice.candidates[static_cast<std::size_t>(choice.knots - kMinCurveKnots)].gain, 0.1);
}

// By chance alone some curve is better by two standard errors in one of 25 recordings: in more than three of 20 in one
// test of a hundred.
TEST(CurveChoice, AProportionalInputIsNotBent) {
  int bent = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) bent += chosen(made({}, 3010, seed)).knots > 0 ? 1 : 0;
  EXPECT_LE(bent, 3);
}

TEST(CurveChoice, AGivenNumberIsTaken) {
  const CurveChoice choice = chosen(made({}, 3010, 1), 5);
  EXPECT_EQ(choice.knots, 5);
  ASSERT_EQ(choice.candidates.size(), 1U);
}

TEST(CurveChoice, TooShortARecordingHasNone) {
  const CurveChoice choice = chosen(made(true_curve(), 20, 1));
  EXPECT_EQ(choice.knots, 0);
  EXPECT_THAT(choice.reason, HasSubstr("too little"));
}

TEST(CurveChoice, AnInputOfTwoValuesHasNone) {
  Recording recording = made({}, 3010, 1);
  for (double& u : recording.channels[0].samples) u = u < 0.5 ? -1 : 2;
  const CurveChoice choice = chosen(recording);
  EXPECT_EQ(choice.knots, 0);
  EXPECT_THAT(choice.reason, HasSubstr("too few values"));
}

}  // namespace
}  // namespace wisp::curve_fit_test
