#include "learn/outline/outline_synthesis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics.hpp"
#include "learn/rows/arx_design.hpp"

namespace wisp::outline_synthesis_test {
namespace {

// y(t) = 0.5 y(t−1) + wind(t) + sd w(t), held between −2 − 2 and 2 + 2.
Model first_order(double sd) {
  ArxModel arx;
  arx.orders = make_orders({.outputs = 1, .inputs = 1, .na = 1, .nb = 1, .nk = 0});
  arx.theta = {{-0.5, 1.0}};
  arx.constant = {0};
  arx.output_mean = {0};
  arx.input_mean = {0};
  arx.noise.sd = {sd};
  Model model;
  model.name = "first order";
  model.rate_hz = 10;
  model.inputs = {{"wind", "", -5, 5, InputShape::kLinear}};
  model.outputs = {{"y", "m", -2, 2}};
  model.dynamics = arx;
  return model;
}

Recording wind(std::vector<double> samples) {
  Recording recording;
  recording.rate_hz = 10;
  recording.channels = {{"wind", "", Role::kInput, std::move(samples)}};
  return recording;
}

TEST(OutlineSynthesis, RowsFollowTheInputFromItsFirstSample) {
  const Recording steps = wind({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  const auto play = synthesize(first_order(0), {.warm_up_seconds = 0, .input = &steps});
  ASSERT_TRUE(play);
  ASSERT_EQ(play->recording.rows(), 20u);
  const auto& y = play->recording.channels[0].samples;
  EXPECT_NEAR(y[0], 1, 1e-6);
  EXPECT_NEAR(y[1], 0.5, 1e-6);
  EXPECT_NEAR(y[4], 0.0625, 1e-6);
  EXPECT_EQ(play->recording.channels[0].name, "y");
  EXPECT_EQ(play->recording.channels[0].unit, "m");
}

TEST(OutlineSynthesis, TheWarmUpEndsWhereTheInputStartsAnew) {
  std::vector<double> pulse(20, 0.0);
  pulse[0] = 1;
  const Recording once = wind(pulse);
  const auto play = synthesize(first_order(0), {.warm_up_seconds = 3.3, .input = &once});
  EXPECT_NEAR(play->recording.channels[0].samples[0], 1, 1e-5);  // what is left of the pulse before: 2^−20
}

TEST(OutlineSynthesis, WithoutInputRowsAreCountedAndWindIsCalm) {
  const auto play = synthesize(first_order(0), {.rows = 7});
  EXPECT_EQ(play->recording.channels[0].samples, std::vector<double>(7, 0.0));
}

TEST(OutlineSynthesis, NoiseHasItsStationarySize) {
  // Variance sd²/(1 − 0.25); over 20 000 samples with a memory of 3 its relative error is near sqrt(2·1.67/20000) =
  // 0.013.
  const auto play = synthesize(first_order(0.3), {.rows = 20000});
  EXPECT_NEAR(deviation(play->recording.channels[0].samples), 0.3 / std::sqrt(0.75), 0.02);
  EXPECT_EQ(play->held_share, 0);
}

TEST(OutlineSynthesis, TheSeedDecides) {
  const auto one = synthesize(first_order(0.3), {.rows = 50, .seed = 1});
  EXPECT_EQ(one->recording.channels[0].samples,
            synthesize(first_order(0.3), {.rows = 50, .seed = 1})->recording.channels[0].samples);
  EXPECT_NE(one->recording.channels[0].samples,
            synthesize(first_order(0.3), {.rows = 50, .seed = 2})->recording.channels[0].samples);
}

// A Gaussian of standard deviation 2 is beyond ±4 in 4.55 % of steps; holding pulls it in a little.
TEST(OutlineSynthesis, HeldStepsAreCounted) {
  const double sd = 2 * std::sqrt(0.75);
  EXPECT_NEAR(synthesize(first_order(sd), {.rows = 100000})->held_share, 0.045, 0.01);
  EXPECT_GT(synthesize(first_order(sd), {.rows = 1000})->held_share, 0.02);
}

TEST(OutlineSynthesis, MissingInputIsCalm) {
  const Recording gap = wind({1, std::numeric_limits<double>::quiet_NaN(), 1});
  const auto play = synthesize(first_order(0), {.warm_up_seconds = 0, .input = &gap});
  EXPECT_NEAR(play->recording.channels[0].samples[1], 0.5, 1e-6);
}

TEST(OutlineSynthesis, AnInputThatIsNotThereIsRefused) {
  Recording rain = wind({1});
  rain.source = "rain.csv";
  rain.channels[0].name = "rain";
  EXPECT_EQ(synthesize(first_order(0), {.input = &rain}).error().message, "rain.csv: there is no input wind");
}

}  // namespace
}  // namespace wisp::outline_synthesis_test
