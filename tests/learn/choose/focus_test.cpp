#include "learn/choose/focus.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "learn/arx/made_system.hpp"
#include "learn/judge/judged_fit.hpp"
#include "learn/judge/prediction.hpp"

namespace wisp::focus_test {
namespace {

using testing::HasSubstr;

const ChannelChoice kChannels{{"u1"}, {"y1"}};

// One lightly damped output.
ArxModel ringing(double noise) {
  ArxModel model;
  model.orders = {OrderMatrix(1, 1, 2), OrderMatrix(1, 1, 2), OrderMatrix(1, 1, 1)};
  model.theta = {{-1.7, 0.9, 1.0, 0.5}};
  model.constant = {0};
  model.output_mean = {5};
  model.input_mean = {1};
  model.noise.sd = {noise};
  return model;
}

// A delay that orders of 2 do not reach, in noise: no model of the given orders describes it.
Recording late_answer(std::size_t rows, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Recording recording = record_system(ringing(0), rows, 11);
  auto& u = recording.channels[0].samples;
  auto& y = recording.channels[1].samples;
  for (double& value : u) value = normal(generator);
  const auto input = [&](std::size_t t, std::size_t lag) { return t >= lag ? u[t - lag] : 0.0; };
  for (std::size_t t = 0; t < rows; ++t) {
    y[t] = (t > 0 ? 0.5 * y[t - 1] : 0) + input(t, 8) + 0.5 * input(t, 11) + 0.1 * normal(generator);
  }
  return recording;
}

arx::FocusedFit focused(std::span<const Recording> recordings, ArxFocus focus, const ArxOptions& options,
                        const ChannelChoice& channels = kChannels) {
  auto plain = fit_arx(recordings, channels, options);
  EXPECT_TRUE(plain) << plain.error().message;
  auto fit = arx::focus_fit(recordings, channels, options, std::move(*plain), focus, {});
  EXPECT_TRUE(fit) << fit.error().message;
  return std::move(*fit);
}

double free_run_fit(const ArxModel& model, const Recording& recording, const ChannelChoice& channels = kChannels) {
  const auto figures = prediction_figures(model, {&recording, 1}, channels, {.steps = {kFreeRun}});
  return figures->front().fit_percent[0];
}

TEST(Focus, TheKernelIsChosenWhereTheOrdersMissTheResponse) {
  const ArxOptions options{.orders = ringing(0).orders};
  const Recording seen = late_answer(1200, 3), unseen = late_answer(600, 4);
  for (const ArxFocus focus : {ArxFocus::kAuto, ArxFocus::kSimulation}) {
    const auto fit = focused({&seen, 1}, focus, options);
    ASSERT_TRUE(fit.outcome.changed);
    EXPECT_THAT(arx::kKernelLags, testing::Contains(fit.fit.model.orders.nb(0, 0)));
    EXPECT_GT(free_run_fit(fit.fit.model, unseen), 85);
  }
}

TEST(Focus, ManyShortRecordingsHaveRowsToHoldOut) {
  std::vector<Recording> brief;
  for (unsigned seed = 0; seed < 40; ++seed) brief.push_back(late_answer(300, seed));
  const auto fit = focused(brief, ArxFocus::kSimulation, {.orders = ringing(0).orders});
  EXPECT_TRUE(fit.outcome.changed) << fit.outcome.reason;
}

// Whichever door a model comes through, its figures are the same: the effective number of coefficients, not their
// count.
TEST(Focus, TheChosenKernelHasTheSummaryOfTheSameKernelAskedFor) {
  const Recording seen = late_answer(1200, 3);
  const auto fit = focused({&seen, 1}, ArxFocus::kAuto, {.orders = ringing(0).orders});
  const int lags = fit.fit.model.orders.nb(0, 0);
  const auto asked = fit_arx({&seen, 1}, kChannels,
                             {.orders = {OrderMatrix(1, 1, lags), OrderMatrix(1, 1, lags), OrderMatrix(1, 1, 0)},
                              .offset = ArxOffset::kEstimate,
                              .kernel = ArxKernel::kTc});
  ASSERT_TRUE(asked) << asked.error().message;
  EXPECT_EQ(fit.fit.model.theta, asked->model.theta);
  EXPECT_EQ(fit.fit.model.std_error, asked->model.std_error);
  EXPECT_EQ(fit.fit.model.noise.sd, asked->model.noise.sd);
  const ArxSummary &one = fit.fit.summary, &other = asked->summary;
  EXPECT_EQ(one.effective, other.effective);
  EXPECT_LT(one.effective[0], 2 * lags);
  EXPECT_EQ(one.fpe, other.fpe);
  EXPECT_EQ(one.aic, other.aic);
  EXPECT_EQ(one.aicc, other.aicc);
  EXPECT_EQ(one.bic, other.bic);
  EXPECT_EQ(one.row_fpe, other.row_fpe);
  EXPECT_EQ(one.usable.reason, other.usable.reason);
}

TEST(Focus, WhatLeastSquaresDescribesIsLeftToIt) {
  const Recording recording = record_system(ringing(1), 1500, 7);
  const auto plain = fit_arx({&recording, 1}, kChannels, {.orders = ringing(1).orders});
  const auto fit = focused({&recording, 1}, ArxFocus::kAuto, {.orders = ringing(1).orders});
  EXPECT_EQ(fit.fit.model.theta, plain->model.theta);
  EXPECT_THAT(fit.outcome.reason, HasSubstr("not surely better"));
}

TEST(Focus, PredictionStaysAtLeastSquares) {
  const Recording recording = late_answer(800, 1);
  const auto fit = focused({&recording, 1}, ArxFocus::kPrediction, {.orders = ringing(0).orders});
  EXPECT_FALSE(fit.outcome.changed);
  EXPECT_TRUE(fit.fit.model.orders == ringing(0).orders);
}

TEST(Focus, AFewRowsAndNoInputsAreLeftToLeastSquaresWithTheReason) {
  const Recording brief = late_answer(8, 1), recording = late_answer(500, 1);
  EXPECT_EQ(focused({&brief, 1}, ArxFocus::kAuto, {.orders = ringing(0).orders}).outcome.reason,
            "too few rows to hold some out");
  const ArxOrders alone{OrderMatrix(1, 1, 2), OrderMatrix(1, 0), OrderMatrix(1, 0)};
  EXPECT_EQ(focused({&recording, 1}, ArxFocus::kSimulation, {.orders = alone}, {{}, {"y1"}}).outcome.reason,
            "no input drives a free simulation");
}

// Of two outputs that do not feed each other one answers late.
TEST(Focus, OutputsThatDoNotFeedEachOtherAreChosenApart) {
  Recording recording = late_answer(1200, 3);
  const auto second = record_system(ringing(1), 1200, 7);
  recording.channels.push_back(second.channels[1]);
  recording.channels.back().name = "y2";
  recording.channels.push_back(second.channels[0]);
  recording.channels.back().name = "u2";
  const ChannelChoice channels{{"u1", "u2"}, {"y1", "y2"}};
  ArxOrders orders{OrderMatrix(2, 2), OrderMatrix(2, 2, 2), OrderMatrix(2, 2, 1)};
  orders.na(0, 0) = orders.na(1, 1) = 2;
  const auto fit = focused({&recording, 1}, ArxFocus::kAuto, {.orders = orders}, channels);
  EXPECT_THAT(arx::kKernelLags, testing::Contains(fit.fit.model.orders.na(0, 0)));
  EXPECT_EQ(fit.fit.model.orders.na(1, 1), 2);
  EXPECT_EQ(fit.options.kernel_outputs, std::vector<int>{0});
  EXPECT_NEAR(fit.fit.summary.effective[1], 7, 1e-9);  // its own coefficients and the level, no kernel's
  EXPECT_LT(fit.fit.summary.effective[0], 3 * fit.fit.model.orders.na(0, 0));
}

}  // namespace
}  // namespace wisp::focus_test
