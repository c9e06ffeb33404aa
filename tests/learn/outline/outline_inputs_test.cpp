#include "learn/outline/outline_inputs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wisp::outline_inputs_test {
namespace {

Recording windy(std::vector<double> wind) {
  Recording recording;
  recording.source = "windy.csv";
  recording.rate_hz = 60;
  const std::size_t rows = wind.size();
  for (const std::string& name : outline_outputs(4)) {
    recording.channels.push_back({name, "", Role::kOutput, std::vector<double>(rows, 0.0)});
  }
  recording.channels.push_back({"wind", "m/s", Role::kInput, std::move(wind)});
  return recording;
}

const std::vector<double>& samples(const Recording& recording, const char* name) {
  return recording.channels[*find_channel(recording, name)].samples;
}

TEST(OutlineInputs, WindOneIsThe95thPercentileWhileItBlows) {
  std::vector<double> wind(1000, 0.01);  // hiss, below a tenth of the gusts
  for (int k = 1; k <= 100; ++k) wind.push_back(0.5 + 0.01 * k);
  const auto input = scaled_input(std::vector{windy(wind)}, "wind");
  ASSERT_TRUE(input);
  EXPECT_NEAR(input->scale, 1.45, 0.011);
  EXPECT_NEAR(input->highest, 1.5 / 1.45, 0.01);
  EXPECT_EQ(input->lowest, 0);
  EXPECT_EQ(input->unit, "m/s");
}

TEST(OutlineInputs, WindFromBothSidesCountsByItsStrength) {
  std::vector<double> wind;
  for (int k = 0; k < 100; ++k) wind.push_back(k % 2 == 0 ? 2 : -1);
  const auto input = scaled_input(std::vector{windy(wind)}, "wind");
  EXPECT_DOUBLE_EQ(input->scale, 2);
  EXPECT_DOUBLE_EQ(input->lowest, -0.5);
}

TEST(OutlineInputs, AStillInputIsRefused) {
  const auto input = scaled_input(std::vector{windy({0, 0, 0})}, "wind");
  ASSERT_FALSE(input);
  EXPECT_EQ(input.error().message, "windy.csv: its input wind is 0 throughout; learn without inputs instead");
}

TEST(OutlineInputs, AMissingInputNamesTheRecording) {
  EXPECT_EQ(scaled_input(std::vector{windy({1})}, "rain").error().message,
            "windy.csv: there is no input rain, which the others have");
}

TEST(OutlineInputs, CalmRowsAreThoseBelowATenth) {
  const std::vector input{OutlineInput{"wind", "m/s", 2, 0, 1}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(calm_rows(windy({0, 0.1, 0.3, -0.3, nan}), input), (std::vector<std::uint8_t>{1, 1, 0, 0, 0}));
  EXPECT_EQ(calm_rows(windy({0, 5}), {}), (std::vector<std::uint8_t>{1, 1}));
}

TEST(OutlineInputs, AnInputBecomesPowersOfItsSizeThenWithItsSign) {
  const std::vector input{OutlineInput{"wind", "m/s", 2, -1, 1}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Recording split = with_regressors(windy({1, -4, nan}), input, {.powers = true});
  EXPECT_EQ(regressor_names(input, {.powers = true}),
            (std::vector<std::string>{"wind size", "wind size root", "wind size square", "wind", "wind root",
                                      "wind square"}));
  EXPECT_EQ(samples(split, "wind size")[0], 0.5);
  EXPECT_EQ(samples(split, "wind")[0], 0.5);
  EXPECT_EQ(samples(split, "wind size")[1], 2);
  EXPECT_EQ(samples(split, "wind")[1], -2);
  EXPECT_EQ(samples(split, "wind size square")[1], 4);
  EXPECT_EQ(samples(split, "wind square")[1], -4);
  EXPECT_EQ(samples(split, "wind root")[1], -std::sqrt(2.0));
  EXPECT_TRUE(std::isnan(samples(split, "wind size")[2]));
  EXPECT_TRUE(std::isnan(samples(split, "wind")[2]));
}

TEST(OutlineInputs, OneSidedInputsAreOnlyScaled) {
  const std::vector input{OutlineInput{"wind", "m/s", 2, 0, 1}};
  EXPECT_EQ(samples(with_regressors(windy({1, 4}), input, {}), "wind"), (std::vector<double>{0.5, 2}));
}

// What was blown aside takes a while to come back: its lean must not pass for its shape at rest.
TEST(OutlineInputs, ItRestsWhenItHasBeenCalmForHalfASecond) {
  Recording recording = windy(std::vector<double>(60, 0.0));
  recording.rate_hz = 20;
  recording.channels[*find_channel(recording, "wind")].samples[15] = 1;
  recording.episode_ids.assign(60, 0);
  std::fill(recording.episode_ids.begin() + 40, recording.episode_ids.end(), 1);
  const std::vector input{OutlineInput{"wind", "m/s", 1, 0, 1}};
  const auto rests = resting_rows(recording, input);
  for (std::size_t row = 0; row < 60; ++row) {
    const bool expected = (row >= 10 && row < 15) || (row >= 26 && row < 40) || row >= 50;
    EXPECT_EQ(rests[row], expected ? 1 : 0) << row;
  }
  EXPECT_EQ(resting_rows(recording, {})[15], 1);
}

TEST(OutlineInputs, TheMeanShapeIsThatOfTheChosenRows) {
  Recording split = windy({1, 0, 0});
  split.channels[*find_channel(split, "p1.y")].samples = {9, 1, 3};
  const OutlineLayout layout = *outline_layout(split);
  EXPECT_EQ(mean_shape(split, layout, std::vector<std::uint8_t>{0, 1, 1})[3], 2);
  EXPECT_TRUE(mean_shape(split, layout, std::vector<std::uint8_t>{0, 0, 0}).empty());
}

}  // namespace
}  // namespace wisp::outline_inputs_test
