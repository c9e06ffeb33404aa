// Whether one way simulates what was held out surely better than another.

#include "learn/judge/held_out.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wisp::arx::held_out_test {
namespace {

// y(t) = a y(t-1) + u(t-1), u a square wave.
Recording made(double a, std::size_t rows) {
  Recording out{
      .source = "made", .rate_hz = 10, .channels = {{"u", "", Role::kInput, {}}, {"y", "", Role::kOutput, {}}}};
  auto &u = out.channels[0].samples, &y = out.channels[1].samples;
  for (std::size_t t = 0; t < rows; ++t) {
    y.push_back(t > 0 ? a * y.back() + u.back() : 0);
    u.push_back(t / 7 % 2 == 0 ? 1 : -1);
  }
  return out;
}

ArxModel model_of(double a) {
  ArxModel model;
  model.orders = {OrderMatrix(1, 1, 1), OrderMatrix(1, 1, 1), OrderMatrix(1, 1, 1)};
  model.theta = {{-a, 1}};
  model.constant = {0};
  model.output_mean = {0};
  model.input_mean = {0};
  return model;
}

const ChannelChoice kChannels{{"u"}, {"y"}};

TEST(FreeRunParts, AreSharesOfTheOutputsVariance) {
  Recording recording = made(0.5, 400);
  const auto exact = free_run_parts(model_of(0.5), {&recording, 1}, kChannels);
  ASSERT_TRUE(exact) << exact.error().message;
  EXPECT_LT(exact->maxCoeff(), 1e-20);
  const auto wrong = *free_run_parts(model_of(0.8), {&recording, 1}, kChannels);
  EXPECT_EQ(wrong.rows(), kParts);
  for (double& y : recording.channels[1].samples) y *= 1e-200;  // no unit counts
  ArxModel small = model_of(0.8);
  small.theta[0][1] = 1e-200;
  EXPECT_TRUE(wrong.isApprox(*free_run_parts(small, {&recording, 1}, kChannels), 1e-9));
}

TEST(FreeRunParts, AMissingSampleIsLeftOut) {
  Recording recording = made(0.5, 400);
  for (std::size_t t = 100; t < 150; ++t) recording.channels[1].samples[t] = std::numeric_limits<double>::quiet_NaN();
  const auto parts = free_run_parts(model_of(0.8), {&recording, 1}, kChannels);
  ASSERT_TRUE(parts);
  EXPECT_TRUE(parts->allFinite());
  EXPECT_GT(parts->col(0)[2], 0);  // nothing is measured there: as the others on average
}

TEST(FreeRunParts, AnOutputThatIsFollowedWellCountsAsMuch) {
  Eigen::MatrixXd others(2, 2), errors(2, 2);
  others << 0.01, 1, 0.03, 1;
  errors << 0.005, 1, 0.015, 1;
  EXPECT_TRUE(relative_errors(errors, others).isApprox(Eigen::Vector2d(0.625, 0.875)));
}

TEST(FreeRunParts, WhatIsBetterInEveryPartIsSure) {
  const Eigen::Vector4d one(1, 2, 3, 4), half = one / 2, mixed(0.5, 4, 1.5, 8);
  EXPECT_GT(standard_errors_below(half, one), 1e6);
  EXPECT_LT(standard_errors_below(one, half), -1e6);
  EXPECT_NEAR(standard_errors_below(mixed, one), 0, 1e-12);
}

TEST(HeldOut, NoFoldLearnsFromRowsThatFollowWhatItHoldsOut) {
  Recording recording;
  recording.rate_hz = 1;
  recording.channels = {{"y", "", Role::kOutput, std::vector<double>(100)}};
  auto& samples = recording.channels[0].samples;
  for (std::size_t t = 0; t < samples.size(); ++t) samples[t] = static_cast<double>(t);
  const auto folds = folds_of({&recording, 1});
  ASSERT_EQ(folds.size(), 3U);
  for (std::size_t k = 0; k < folds.size(); ++k) {
    const auto &learned = folds[k].learned[0].channels[0].samples, &held_out = folds[k].held_out[0].channels[0].samples;
    EXPECT_EQ(learned.size(), 40 + 20 * k);
    EXPECT_EQ(held_out.size(), 20U);
    EXPECT_EQ(held_out.front(), learned.back() + 1);
  }
}

TEST(HeldOut, MiddlesOfManyBriefRecordingsAreLongEnoughForLags) {
  EXPECT_EQ(middles_of(std::vector<Recording>(2, made(0.5, 16384)), 8192).front().rows(), 4096U);
  EXPECT_EQ(middles_of(std::vector<Recording>(100, made(0.5, 800)), 8192).front().rows(), 400U);
}

TEST(HeldOut, BetterInTheMeanIsNotSurelyBetterWhereItIsByChance) {
  const Eigen::VectorXd others = Eigen::VectorXd::Ones(3 * kParts);
  Eigen::VectorXd errors = 0.5 * others;
  errors[3] = 0.6;
  EXPECT_TRUE(surely_better(errors, others));
  EXPECT_FALSE(surely_better(others, others));
  for (Eigen::Index k = 0; k < errors.size(); ++k) errors[k] = k % 2 == 0 ? 0.4 : 2;  // 0.89 in the mean logarithm
  EXPECT_FALSE(surely_better(errors, others));
}

}  // namespace
}  // namespace wisp::arx::held_out_test
