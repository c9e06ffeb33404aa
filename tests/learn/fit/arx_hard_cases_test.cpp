// Recordings that break a careless estimator, each with its right answer.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "learn/judge/judged_fit.hpp"
#include "learn/rows/arx_design.hpp"

namespace wisp::arx_hard_cases_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
const std::vector<double> kTruth{-1.5, 0.7, 1.0, 0.5};

// y(t) = 1.5 y(t−1) − 0.7 y(t−2) + u(t−1) + 0.5 u(t−2) + noise · e(t).
Recording second_order(std::size_t rows, double noise = 0, unsigned seed = 1) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  std::vector<double> u(rows), y(rows);
  for (std::size_t t = 0; t < rows; ++t) {
    u[t] = normal(generator);
    y[t] = noise * normal(generator);
    if (t >= 2) y[t] += 1.5 * y[t - 1] - 0.7 * y[t - 2] + u[t - 1] + 0.5 * u[t - 2];
  }
  Recording recording;
  recording.source = "second_order";
  recording.rate_hz = 10;
  recording.channels = {{"u", "", Role::kInput, u}, {"y", "", Role::kOutput, y}};
  return recording;
}

ArxOptions options(int inputs = 1, int na = 2, int nb = 2, int nk = 1) {
  ArxOptions options;
  options.orders = make_orders({.outputs = 1, .inputs = inputs, .na = na, .nb = nb, .nk = nk});
  return options;
}

ArxFit fit(const Recording& recording, const ArxOptions& options, const ChannelChoice& channels = {{"u"}, {"y"}}) {
  auto result = fit_arx({&recording, 1}, channels, options);
  EXPECT_TRUE(result) << result.error().message;
  return result ? *result : ArxFit{};
}

std::string error_of(const Recording& recording, const ArxOptions& options,
                     const ChannelChoice& channels = {{"u"}, {"y"}}) {
  const auto result = fit_arx({&recording, 1}, channels, options);
  EXPECT_FALSE(result);
  return result ? "" : result.error().message;
}

void expect_near(const std::vector<double>& got, const std::vector<double>& want, double tolerance) {
  ASSERT_EQ(got.size(), want.size());
  for (std::size_t p = 0; p < want.size(); ++p) EXPECT_NEAR(got[p], want[p], tolerance) << p;
}

TEST(ArxHardCases, ConstantInputIsNamedAndItsCoefficientsAreZero) {
  Recording recording = second_order(300, 0.1);
  recording.channels.push_back({"still", "", Role::kInput, std::vector<double>(300, 0.1)});
  const ArxFit got = fit(recording, options(2), {{"u", "still"}, {"y"}});
  ASSERT_EQ(got.summary.rank_problems.size(), 2u);
  EXPECT_EQ(got.summary.rank_problems[0].channel, "still");
  EXPECT_EQ(got.summary.rank_problems[0].lag, 1);
  EXPECT_EQ(got.summary.rank_problems[1].lag, 2);
  EXPECT_THAT(got.summary.rank_problems[0].reason, HasSubstr("never changes"));
  EXPECT_FALSE(got.summary.usable.verdict);
  EXPECT_THAT(got.summary.usable.reason, HasSubstr("'still'"));
  EXPECT_EQ(got.model.theta[0][4], 0);
  EXPECT_EQ(got.model.theta[0][5], 0);
  EXPECT_NEAR(got.model.theta[0][0], -1.5, 0.05);
  EXPECT_TRUE(check(got.model));
}

TEST(ArxHardCases, TwoIdenticalInputsAreNamedBoth) {
  Recording recording = second_order(300, 0.1);
  recording.channels.push_back({"twin", "", Role::kInput, recording.channels[0].samples});
  const ArxFit got = fit(recording, options(2), {{"u", "twin"}, {"y"}});
  ASSERT_EQ(got.summary.rank_problems.size(), 2u);
  EXPECT_EQ(got.summary.rank_problems[0].reason, "'twin' at lag 1 tells the same as 'u' at lag 1");
  EXPECT_EQ(got.summary.rank_problems[1].reason, "'twin' at lag 2 tells the same as 'u' at lag 2");
  EXPECT_FALSE(got.summary.usable.verdict);
}

TEST(ArxHardCases, OneMissingSampleInAHundredThousandCostsItsRowsOnly) {
  Recording recording = second_order(100000, 0.1);
  recording.channels[1].samples[54321] = kMissing;
  const ArxFit got = fit(recording, options());
  EXPECT_EQ(got.summary.rows_left_out, 3u);
  EXPECT_EQ(got.summary.rows, 100000u - 2 - 3);
  expect_near(got.model.theta[0], kTruth, 0.01);
  EXPECT_TRUE(got.summary.usable.verdict);
}

TEST(ArxHardCases, EpisodesShorterThanTheOrderAreSkippedAndCounted) {
  Recording recording = second_order(500);
  for (std::size_t t = 0; t < 500; ++t) recording.episode_ids.push_back(t < 250 ? 1 : t < 252 ? 2 : 3);
  const ArxFit got = fit(recording, options());
  EXPECT_EQ(got.summary.episodes_used, 2u);
  EXPECT_EQ(got.summary.episodes_skipped, 1u);
  EXPECT_EQ(got.summary.rows, 500u - 2 - 2 - 2);
}

TEST(ArxHardCases, NoHistoryCrossesFromOneEpisodeToTheNext) {
  Recording recording = second_order(400);
  for (std::size_t t = 0; t < 400; ++t) recording.episode_ids.push_back(t < 200 ? 1 : 2);
  for (std::size_t t = 200; t < 400; ++t) recording.channels[1].samples[t] += 1000;  // no longer one trajectory
  ArxOptions none = options();
  none.offset = ArxOffset::kNone;
  Recording first = slice(recording, 0, 200);
  const auto joined = fit_arx(std::vector<Recording>{first, second_order(200, 0, 2)}, {{"u"}, {"y"}}, none);
  ASSERT_TRUE(joined);
  expect_near(joined->model.theta[0], kTruth, 1e-10);
}

TEST(ArxHardCases, MoreCoefficientsThanRowsIsAnError) {
  EXPECT_THAT(error_of(second_order(9), options(1, 4, 4, 1)), AllOf(HasSubstr("8 coefficients"), HasSubstr("5 rows")));
}

TEST(ArxHardCases, DelayLongerThanTheRecordingIsAnError) {
  EXPECT_THAT(error_of(second_order(100), options(1, 2, 2, 200)), HasSubstr("201"));
}

TEST(ArxHardCases, OrdersOfZeroGiveAModelOfTheMean) {
  const Recording recording = second_order(300, 0.1);
  const ArxFit got = fit(recording, options(1, 0, 0, 0));
  EXPECT_TRUE(got.model.theta[0].empty());
  EXPECT_EQ(got.summary.rows, 300u);
  EXPECT_NEAR(got.summary.fit_percent[0], 0, 1e-9);
  EXPECT_EQ(got.summary.stable.radius, 0);
  EXPECT_TRUE(check(got.model));
}

TEST(ArxHardCases, OrderZeroOfOutputsIsAFiniteImpulseResponse) {
  const Recording recording = second_order(300);
  const ArxFit got = fit(recording, options(1, 0, 1, 1));
  EXPECT_EQ(got.model.theta[0].size(), 1u);
  EXPECT_EQ(got.summary.first_sample, 1);
  EXPECT_NEAR(got.model.theta[0][0], 1, 0.5);
}

TEST(ArxHardCases, HugeAndTinyUnitsGiveTheSameModel) {
  Recording recording = second_order(500, 0.1);
  const ArxFit plain = fit(recording, options());
  for (double& sample : recording.channels[0].samples) sample *= 1e12;
  for (double& sample : recording.channels[1].samples) sample *= 1e-12;
  const ArxFit got = fit(recording, options());
  for (std::size_t p = 0; p < 4; ++p) {
    const double unit = p < 2 ? 1 : 1e-24;
    EXPECT_NEAR(got.model.theta[0][p] / unit / plain.model.theta[0][p], 1, 1e-12) << p;
    EXPECT_NEAR(got.model.std_error[0][p] / unit / plain.model.std_error[0][p], 1, 1e-10) << p;
  }
  EXPECT_NEAR(got.summary.loss[0] / plain.summary.loss[0], 1e-24, 1e-35);
  EXPECT_TRUE(got.summary.usable.verdict);
}

TEST(ArxHardCases, LargeOperatingPointDoesNotCostDigits) {
  Recording recording = second_order(500);
  for (double& sample : recording.channels[1].samples) sample += 1e6;
  ArxOptions about_constant = options();
  about_constant.offset = ArxOffset::kEstimate;
  expect_near(fit(recording, about_constant).model.theta[0], kTruth, 1e-8);
}

TEST(ArxHardCases, EstimatedConstantFindsTheOffsetOfTheEquation) {
  Recording recording = second_order(2000);
  std::vector<double>& y = recording.channels[1].samples;
  const std::vector<double>& u = recording.channels[0].samples;
  for (std::size_t t = 2; t < y.size(); ++t) y[t] = 1.5 * y[t - 1] - 0.7 * y[t - 2] + u[t - 1] + 0.5 * u[t - 2] + 3;
  ArxOptions about_constant = options();
  about_constant.offset = ArxOffset::kEstimate;
  const ArxFit got = fit(recording, about_constant);
  expect_near(got.model.theta[0], kTruth, 1e-9);
  const double constant = got.model.constant[0] + 0.2 * got.model.output_mean[0] - 1.5 * got.model.input_mean[0];
  EXPECT_NEAR(constant, 3, 1e-8);
}

TEST(ArxHardCases, OutputThatNeverChangesIsNotUsable) {
  Recording recording = second_order(300);
  std::fill(recording.channels[1].samples.begin(), recording.channels[1].samples.end(), 7.25);
  const ArxFit got = fit(recording, options());
  EXPECT_FALSE(got.summary.usable.verdict);
  EXPECT_THAT(got.summary.usable.reason, HasSubstr("'y' never changes"));
  EXPECT_TRUE(check(got.model));
}

TEST(ArxHardCases, InfiniteSampleIsAnError) {
  Recording recording = second_order(300);
  recording.channels[1].samples[5] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(error_of(recording, options()), AllOf(HasSubstr("'y'"), HasSubstr("infinite")));
}

TEST(ArxHardCases, ChannelWithoutSamplesIsAnError) {
  Recording recording = second_order(300);
  std::fill(recording.channels[0].samples.begin(), recording.channels[0].samples.end(), kMissing);
  EXPECT_THAT(error_of(recording, options()), AllOf(HasSubstr("'u'"), HasSubstr("missing")));
}

TEST(ArxHardCases, UnknownChannelIsAnErrorThatNamesWhatThereIs) {
  EXPECT_THAT(error_of(second_order(300), options(), {{"wind"}, {"y"}}),
              AllOf(HasSubstr("second_order"), HasSubstr("'wind'"), HasSubstr("u, y")));
}

TEST(ArxHardCases, RecordingsOfDifferentRatesAreAnError) {
  std::vector<Recording> recordings{second_order(300), second_order(300)};
  recordings[1].rate_hz = 25;
  const auto result = fit_arx(recordings, {{"u"}, {"y"}}, options());
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().message, HasSubstr("samples a second"));
}

TEST(ArxHardCases, RatesThatDifferByTheErrorOfAClockAreOne) {
  std::vector<Recording> recordings{second_order(300), second_order(300)};
  recordings[1].rate_hz *= 1.0003;
  EXPECT_TRUE(fit_arx(recordings, {{"u"}, {"y"}}, options()));
}

TEST(ArxHardCases, OrderMatricesOfTheWrongShapeAreAnError) {
  ArxOptions wrong = options();
  wrong.orders.na = OrderMatrix(2, 2, 1);
  EXPECT_THAT(error_of(second_order(300), wrong), AllOf(HasSubstr("na is 2 × 2"), HasSubstr("1 × 1")));
}

}  // namespace
}  // namespace wisp::arx_hard_cases_test
