// Outlines that answer to wind.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/statistics.hpp"
#include "learn/outline/made_outline.hpp"
#include "learn/outline/outline_fit.hpp"
#include "learn/outline/outline_synthesis.hpp"

namespace wisp::outline_wind_test {
namespace {

constexpr made::OutlineRecipe kWindy{.points = 6, .rows = 2400, .shock = 0.003, .wind = true};
constexpr made::OutlineRecipe kFromBothSides{
    .points = 6, .rows = 2400, .shock = 0.003, .wind = true, .both_sides = true};

OutlineFit learned(const made::OutlineRecipe& recipe, const OutlineRecipe& options = {}) {
  const std::vector recordings{made::outline_recording(recipe)};
  auto fit = fit_outline(recordings, options);
  EXPECT_TRUE(fit) << (fit ? "" : fit.error().message);
  return *std::move(fit);
}

const ArxModel& arx(const OutlineFit& fit) { return std::get<ArxModel>(fit.model.dynamics); }

// Where an output comes to rest under a steady wind without noise.
double resting(const Model& model, double wind, const char* output) {
  Recording blow;
  blow.rate_hz = model.rate_hz;
  blow.channels.push_back({"wind", "", Role::kInput, std::vector<double>(400, wind)});
  const auto play = synthesize(model, {.noise = 0, .input = &blow});
  EXPECT_TRUE(play);
  return play->recording.channels[*find_channel(play->recording, output)].samples.back();
}

// A recording in which nobody blows and the flame flickers by `shock`.
Recording calm_recording(double shock, std::size_t rows = 1200) {
  Recording calm = made::outline_recording({.points = 6, .rows = rows, .shock = shock, .wind = true, .lean = 0});
  calm.source = "calm.csv";
  auto& wind = calm.channels[*find_channel(calm, "wind")].samples;
  std::fill(wind.begin(), wind.end(), 0.0);
  return calm;
}

TEST(OutlineWind, TheTipIsFollowedFromTheWindAlone) {
  const OutlineFit fit = learned(kWindy);
  ASSERT_TRUE(fit.summary.held_out);
  EXPECT_GT(fit.summary.held_out->tip_fit_percent.back(), 60);
  EXPECT_GT(fit.summary.held_out->overlap.back(), 0.7);
  EXPECT_TRUE(fit.summary.usable.verdict) << fit.summary.usable.reason;
}

TEST(OutlineWind, OneIsThe95thPercentileAndItsUnitIsKept) {
  const OutlineFit fit = learned(kWindy);
  ASSERT_EQ(fit.model.inputs.size(), 1u);
  EXPECT_EQ(fit.model.inputs[0].shape, InputShape::kEvenOdd);
  EXPECT_NE(fit.model.inputs[0].unit.find("m/s"), std::string::npos);
  EXPECT_DOUBLE_EQ(fit.model.inputs[0].lowest, -fit.model.inputs[0].highest);
  EXPECT_GT(fit.model.inputs[0].highest, 1);
  EXPECT_GT(fit.summary.inputs[0].scale, 1.5);
}

// Learned from wind out of the left only: a gust from the right leans it the other way, and it does not grow.
TEST(OutlineWind, AGustFromTheOtherSideIsTheMirrorImage) {
  const OutlineFit fit = learned(kWindy);
  const auto moved = [&](double wind, const char* output) {
    return resting(fit.model, wind, output) - resting(fit.model, 0, output);
  };
  EXPECT_GT(moved(0.8, "p2.x"), 0.05);
  EXPECT_NEAR(moved(-0.8, "p3.x"), -moved(0.8, "p2.x"), 3e-4);
  EXPECT_LT(moved(0.8, "p3.y"), -0.01);
  EXPECT_NEAR(moved(-0.8, "p2.y"), moved(0.8, "p3.y"), 3e-4);
}

// A wick that stands askew: the learned flame stands askew when it is calm, and leans from there to both sides.
TEST(OutlineWind, WhatStandsAskewStaysAskew) {
  Recording recording = made::outline_recording(kWindy);
  for (const char* name : {"p2.x", "p3.x"}) {
    for (double& x : recording.channels[*find_channel(recording, name)].samples) x += 20;
  }
  const auto fit = fit_outline(std::vector{recording});
  ASSERT_TRUE(fit) << fit.error().message;
  const double middle = (resting(fit->model, 0, "p2.x") + resting(fit->model, 0, "p3.x")) / 2;
  EXPECT_NEAR(middle, 20 / fit->summary.pixels_per_unit, 0.01);
}

TEST(OutlineWind, WindFromBothSidesIsLearnedWithItsSign) {
  const OutlineFit fit = learned(kFromBothSides);
  EXPECT_GT(fit.summary.held_out->tip_fit_percent.back(), 60);
  EXPECT_GT(resting(fit.model, 0.8, "p2.x"), resting(fit.model, 0, "p2.x") + 0.05);
  EXPECT_LT(resting(fit.model, -0.8, "p2.x"), resting(fit.model, 0, "p2.x") - 0.05);
}

TEST(OutlineWind, InputsCanBeLeftOut) {
  const OutlineFit fit = learned(kWindy, {.inputs = std::vector<std::string>{}});
  EXPECT_TRUE(fit.model.inputs.empty());
  EXPECT_EQ(arx(fit).orders.inputs(), 0);
}

TEST(OutlineWind, AnInputThatIsNotThereIsRefused) {
  const std::vector recordings{made::outline_recording(kWindy)};
  const auto fit = fit_outline(recordings, {.inputs = std::vector<std::string>{"rain"}});
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().message, "made 1: there is no input rain, which the others have");
}

TEST(OutlineWind, WindThatExplainsNothingMakesTheModelUnusable) {
  Recording recording = made::outline_recording({.rows = 1500, .wind = true, .lean = 0});
  const auto fit = fit_outline(std::vector{recording});
  ASSERT_TRUE(fit);
  EXPECT_FALSE(fit->summary.usable.verdict);
  EXPECT_NE(fit->summary.usable.reason.find("from its inputs alone"), std::string::npos) << fit->summary.usable.reason;
}

// The flicker is what the wind leaves unexplained: at rest without wind the model moves as much as a calm flame.
TEST(OutlineWind, NoiseIsOnlyWhatTheWindLeaves) {
  const OutlineFit windy = learned(kWindy);
  made::OutlineRecipe calm = kWindy;
  calm.wind = false;
  const OutlineFit still = learned(calm);
  const auto spread = [](const Model& model) {
    return deviation(synthesize(model, {.rows = 100000})->recording.channels[4].samples);
  };
  const double scale = windy.summary.pixels_per_unit / still.summary.pixels_per_unit;
  EXPECT_NEAR(spread(windy.model) * scale / spread(still.model), 1, 0.15);
}

// Whether it moves as much as the recording is asked where something moves, whichever recording comes first.
TEST(OutlineWind, ACalmRecordingBeforeTheOthersIsNoReasonAgainstTheModel) {
  const Recording calm = calm_recording(0.0002), windy = made::outline_recording(kWindy);
  for (const auto& recordings : {std::vector{calm, windy}, std::vector{windy, calm}}) {
    const auto fit = fit_outline(recordings);
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_TRUE(fit->summary.usable.verdict) << fit->summary.usable.reason;
    for (double ratio : fit->summary.trial.sd_ratio) EXPECT_NEAR(ratio, 1, 0.4);
  }
}

// Every recording's end is held out, so that the shapes of a calm one alone are no measure for those of a windy one.
TEST(OutlineWind, TheOrderOfTheRecordingsDoesNotDecideWhichShapesAreForeign) {
  const Recording calm = calm_recording(0.001, 2 * kWindy.rows), windy = made::outline_recording(kWindy);
  for (const auto& recordings : {std::vector{calm, windy}, std::vector{windy, calm}}) {
    const auto fit = fit_outline(recordings);
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_LT(fit->summary.trial.outside, 0.1);
  }
}

TEST(OutlineWind, ARecordingThatIsPlayedWithFarMoreMotionIsNamed) {
  made::OutlineRecipe again = kWindy;
  again.seed += 1;
  const Recording windy = made::outline_recording(kWindy), other = made::outline_recording(again);
  const auto warnings = [](const std::vector<Recording>& recordings) {
    const auto fit = fit_outline(recordings);
    return fit ? fit->summary.warnings : std::vector<std::string>{fit.error().message};
  };
  using testing::Contains, testing::HasSubstr, testing::Not;
  EXPECT_THAT(warnings({windy, calm_recording(0.0002)}), Contains(HasSubstr("calm.csv: along its input the model")));
  EXPECT_THAT(warnings({windy, other}), Not(Contains(HasSubstr("along its input"))));
}

TEST(OutlineWind, TheCalmHeightIsTheUnitHoweverHardItBlows) {
  made::OutlineRecipe hard = kWindy;
  hard.lean = 0.08;
  made::OutlineRecipe calm = hard;
  calm.wind = false;
  const double still = learned(calm).summary.pixels_per_unit;
  // Over all rows the height is some per cent less; the rests hold the end of a gust's swing.
  EXPECT_NEAR(learned(hard).summary.pixels_per_unit / still, 1, 0.01);
}

}  // namespace
}  // namespace wisp::outline_wind_test
