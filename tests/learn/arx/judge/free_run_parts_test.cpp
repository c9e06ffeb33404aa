// Whether one way simulates what was held out surely better than another.

#include "learn/arx/judge/free_run_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wisp::arx::free_run_parts_test {
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

}  // namespace
}  // namespace wisp::arx::free_run_parts_test
