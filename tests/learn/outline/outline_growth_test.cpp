// Noise that grows with the wind: learned where the data say so, and only there.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "learn/fidelity/fidelity_marginal.hpp"
#include "learn/outline/made_outline.hpp"
#include "learn/outline/outline_synthesis.hpp"
#include "wisp/learn/outline.hpp"

namespace wisp {
namespace {

using testing::HasSubstr;

// The wind acts gently, so that what is left is noise and not lean.
constexpr made::OutlineRecipe kSteady{.rows = 2400, .shock = 0.004, .wind = true};
constexpr made::OutlineRecipe kGusty{.rows = 2400, .shock = 0.004, .shock_growth = 2, .wind = true};

OutlineFit learned(const made::OutlineRecipe& recipe, OutlineOptions options = {}) {
  options.noise = OutlineNoise::kMatched;  // drawn residuals are as large as they were
  auto fit = learn_outline(std::vector{made::outline_recording(recipe)}, options);
  EXPECT_TRUE(fit);
  return *std::move(fit);
}

const ResidualNoise& noise_of(const OutlineFit& fit) { return std::get<ArxModel>(fit.model.dynamics).noise; }

// A model's wind 1 is the 95th percentile of the recording's, so its growth is as much larger than the made one's.
TEST(OutlineGrowth, IsFoundAndKeptWhereTheDataSaySo) {
  const OutlineFit fit = learned(kGusty);
  const OutlineNoiseGrowth& growth = fit.summary.noise_growth;
  ASSERT_TRUE(growth.kept) << growth.reason;
  const double made = 2 * fit.summary.inputs[0].scale / kGusty.wind_unit;
  EXPECT_NEAR(growth.per_input[0], made, 0.2 * made);
  EXPECT_GT(growth.gain, 2 * growth.gain_error);
  // The mean of eight frames of either sign of wind.
  EXPECT_EQ(noise_of(fit).growth, std::vector<double>(16, growth.per_input[0] / 8));
  EXPECT_THAT(growth.reason, HasSubstr("grows"));
}

TEST(OutlineGrowth, IsNotKeptWhereNoiseIsTheSameInAnyWind) {
  const OutlineFit fit = learned(kSteady);
  EXPECT_FALSE(fit.summary.noise_growth.kept) << fit.summary.noise_growth.reason;
  EXPECT_TRUE(noise_of(fit).growth.empty());
}

TEST(OutlineGrowth, NeedsSomethingHeldOutAndCanBeSwitchedOff) {
  EXPECT_FALSE(learned(kGusty, {.holdout = 0}).summary.noise_growth.kept);
  const OutlineFit off = learned(kGusty, {.growing_noise = false});
  EXPECT_TRUE(noise_of(off).growth.empty());
  EXPECT_TRUE(off.summary.noise_growth.per_input.empty());
}

TEST(OutlineGrowth, WithoutInputsThereIsNothingToGrowWith) {
  const OutlineFit fit = learned({.rows = 900});
  EXPECT_FALSE(fit.summary.noise_growth.kept);
  EXPECT_THAT(fit.summary.noise_growth.reason, HasSubstr("no input"));
}

TEST(OutlineGrowth, SquaresGetNone) {
  const OutlineFit fit = learned(kGusty, {.square = true});
  ASSERT_TRUE(fit.summary.noise_growth.kept);
  const std::vector<double>& growth = noise_of(fit).growth;
  ASSERT_EQ(growth.size(), 32u);
  EXPECT_GT(growth[15], 0);
  EXPECT_EQ(growth[16], 0);
  EXPECT_EQ(growth[31], 0);
}

// Played in calm it flickers less than in steady wind, and along the recording's wind as much as the recording does.
TEST(OutlineGrowth, IsPlayed) {
  const OutlineFit fit = learned(kGusty);
  const auto flicker = [&](double wind) {
    Recording input;
    input.rate_hz = 30;
    input.channels = {{"wind", "", Role::kInput, std::vector<double>(100, wind)}};
    const auto play = synthesize(fit.model, {.rows = 5000, .input = &input});
    return standard_deviation(play->recording.channels[4].samples);
  };
  const double growth = fit.summary.noise_growth.per_input[0];
  EXPECT_NEAR(flicker(0.5) / flicker(0), 1 + 0.5 * growth, 0.15);
  EXPECT_NEAR(fit.summary.sd_ratio[4], 1, 0.1);
}

}  // namespace
}  // namespace wisp
