// A light that is calm and restless by turns is learned as one.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/statistics.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/model/file.hpp"

namespace wisp::learn_flicker_test {
namespace {

// Three minutes and more of a light whose restless stretches swing at 5 Hz.
Recording light(double rate_hz, std::uint64_t seed, double seconds = 400) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const double angle = 2 * 3.14159265358979 * 5 / rate_hz, r = std::exp(-6 / rate_hz);
  std::vector<double> samples;
  double a = 0, b = 0;
  bool restless = false;
  for (double t = 0; t < seconds * rate_hz; t += 1) {
    if (uniform(random) * rate_hz < (restless ? 0.5 : 0.35)) restless = !restless;
    const double next = 2 * r * std::cos(angle) * a - r * r * b + (restless ? 0.06 : 0.0008) * normal(random);
    b = std::exchange(a, next);
    samples.push_back(3 * (1 + a));
  }
  return {.source = "light.csv", .rate_hz = rate_hz, .channels = {{"brightness", "", Role::kOutput, samples}}};
}

double figure(const Fit& fit, const std::string& name) {
  for (const Figure& each : fit.model.training.figures) {
    if (each.name == name) return each.value;
  }
  ADD_FAILURE() << "no figure " << name;
  return 0;
}

TEST(LearnFlicker, PlaysAsCalmAndAsStronglyAsWhatWasHeldOut) {
  // What is held out has some 120 turns: its own share of calm is known to 0.04.
  const auto fit = learn(light(50, 1, 2000), FlickerRecipe{.name = "light"});
  ASSERT_TRUE(fit) << fit.error().message;
  ASSERT_TRUE(check(fit->model));
  EXPECT_EQ(fit->model.rate_hz, 50);
  EXPECT_TRUE(fit->report.verdict->usable) << fit->report.verdict->reason;
  EXPECT_NEAR(figure(*fit, "played_calm_share"), figure(*fit, "held_out_calm_share"), 0.10);
  EXPECT_NEAR(figure(*fit, "played_sd") / figure(*fit, "held_out_sd"), 1, 0.15);
  EXPECT_GT(figure(*fit, "played_calm_share"), 0.2);
  // What an exported lamp draws its shocks from: here, normal ones.
  const auto& quantiles = std::get<SwitchedArxModel>(fit->model.dynamics).shock_quantiles;
  ASSERT_EQ(quantiles.size(), 17u);
  EXPECT_NEAR(quantiles[8], 0, 0.1);
  EXPECT_NEAR(quantiles[12], 0.6745, 0.15);
  EXPECT_GT(quantiles[16], 2.5);
}

TEST(LearnFlicker, TheModelKeepsTheNameOfItsSourceWithoutTheUsersFolders) {
  Recording trace = light(50, 1, 2000);
  trace.source = "films of home/lamp.csv";
  const auto fit = learn(trace, FlickerRecipe{});
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(fit->model.training.sources, std::vector<std::string>{"lamp.csv"});
}

TEST(LearnFlicker, AFasterTraceIsAveragedDown) {
  const auto fit = learn(light(200, 2), FlickerRecipe{.rate_hz = 50});
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(fit->model.rate_hz, 50);
}

TEST(LearnFlicker, ALightThatChangesItsWaysIsNotUsable) {
  Recording changing = light(50, 3);
  auto& samples = changing.channels[0].samples;
  for (std::size_t k = samples.size() * 7 / 10; k < samples.size(); ++k) samples[k] = 3 + 0.01 * (samples[k] - 3);
  const auto fit = learn(changing, FlickerRecipe{});
  ASSERT_TRUE(fit);
  EXPECT_FALSE(fit->report.verdict->usable);
  EXPECT_NE(fit->report.verdict->reason.find("record for longer"), std::string::npos);
}

TEST(LearnFlicker, BriefStretchesLeaveHalfASecondOnBothSidesOrAreLeftOut) {
  Recording broken = light(50, 5, 300);
  for (std::size_t k = 0; k < broken.rows(); k += 150) broken.channels[0].samples[k] = std::nan("");
  EXPECT_TRUE(learn(broken, FlickerRecipe{}));
  for (std::size_t k = 0; k < broken.rows(); k += 75) broken.channels[0].samples[k] = std::nan("");
  const auto fit = learn(broken, FlickerRecipe{});
  ASSERT_FALSE(fit);
  EXPECT_NE(fit.error().message.find("light.csv: the light lasts 0 s in stretches of at least 2"), std::string::npos)
      << fit.error().message;
}

TEST(LearnFlicker, WhatCannotBeLearnedFromIsSaid) {
  const auto says = [](const Recording& recording, const FlickerRecipe& recipe, const std::string& words) {
    const auto fit = learn(recording, recipe);
    ASSERT_FALSE(fit);
    EXPECT_NE(fit.error().message.find(words), std::string::npos) << fit.error().message;
  };
  says(light(50, 4, 10), {}, "expected at least 20 s");
  says(light(50, 4), {.output = "colour"}, "has no channel \"colour\"");
  says(light(50, 4), {.modes = 1}, "expected 2 to 8");
  says(light(50, 4), {.rate_hz = 2}, "expected 10 to 1000");
  Recording alternating = light(50, 4);  // its mean was taken off
  const double level = mean(alternating.channels[0].samples);
  for (double& value : alternating.channels[0].samples) value = value - level + 1e-14;
  says(alternating, {}, "not above 0");
  Recording outline = light(50, 4);
  outline.channels[0].name = "p0.x";
  EXPECT_TRUE(learn(outline, FlickerRecipe{})) << "an only output is the light";
  outline.channels.push_back(outline.channels[0]);
  outline.channels[1].name = "p0.y";
  says(outline, {}, "no channel \"brightness\", and 2 outputs");
  Recording dark = light(50, 4);
  for (double& value : dark.channels[0].samples) value = 0;
  says(dark, {}, "not above 0");
  Recording burnt_down = light(50, 4);
  for (std::size_t k = burnt_down.rows() / 2; k < burnt_down.rows(); ++k) burnt_down.channels[0].samples[k] = 0;
  says(burnt_down, {}, "out in the last 30 %");
}

TEST(LearnFlicker, RatesOfTwoClocksAreOneRate) {
  const Recording both[] = {light(50, 2), light(50.02, 3)};
  const auto fit = learn(both, FlickerRecipe{});
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(fit->model.rate_hz, 50);
}

}  // namespace
}  // namespace wisp::learn_flicker_test
