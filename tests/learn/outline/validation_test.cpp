#include "learn/outline/outline_judgement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "learn/outline/made_outline.hpp"
#include "learn/outline/outline_fit.hpp"
#include "learn/outline/outline_inputs.hpp"
#include "learn/outline/outline_preparation.hpp"
#include "learn/outline/outline_shape.hpp"
#include "learn/outline/outline_synthesis.hpp"
#include "model/bspline.hpp"

namespace wisp::validation_test {
namespace {

constexpr made::OutlineRecipe kWindy{.rows = 1200, .shock = 0.003, .wind = true};
constexpr made::OutlineRecipe kCalm{.rows = 1200};

Model learned(const made::OutlineRecipe& recipe) {
  const std::vector recordings{made::outline_recording(recipe)};
  auto fit = fit_outline(recordings);
  EXPECT_TRUE(fit);
  return fit->model;
}

const Model& windy_model() {
  static const Model model = learned(kWindy);
  return model;
}

const Model& calm_model() {
  static const Model model = learned(kCalm);
  return model;
}

// A recording that learning has not seen.
Recording unseen(made::OutlineRecipe recipe) {
  recipe.rows = 600;
  recipe.seed = 7;
  return made::outline_recording(recipe);
}

OutlineJudgement validated(const Model& model, const Recording& recording, ValidationOptions options = {}) {
  options.play_seconds = 20;
  auto result = judge_outline(model, recording, options);
  EXPECT_TRUE(result) << (result ? "" : result.error().message);
  return *std::move(result);
}

const std::vector<double>& samples(const Recording& recording, const char* name) {
  return recording.channels[*find_channel(recording, name)].samples;
}

TEST(Validation, ARecordingThatLearningHasNotSeenIsFollowedFromItsWind) {
  const OutlineJudgement out = validated(windy_model(), unseen(kWindy), {.fidelity = false});
  EXPECT_GT(out.figures.tip_fit_percent.back(), 60);
  EXPECT_GT(out.figures.overlap.back(), 0.75);
  for (const OutlineChannelFigures& channel : out.figures.channels) {
    EXPECT_GT(channel.fit_percent[0], 0) << channel.name;
  }
}

TEST(Validation, TheOrderOfColumnsDoesNotMatter) {
  Recording wind_first = unseen(kWindy);
  std::rotate(wind_first.channels.begin(), wind_first.channels.end() - 1, wind_first.channels.end());
  std::swap(wind_first.channels[3], wind_first.channels[8]);
  ASSERT_EQ(wind_first.channels[0].name, "wind");
  const OutlineJudgement one = validated(windy_model(), unseen(kWindy), {.fidelity = false});
  const OutlineJudgement two = validated(windy_model(), wind_first, {.fidelity = false});
  EXPECT_EQ(one.figures.tip_fit_percent, two.figures.tip_fit_percent);
  EXPECT_EQ(samples(one.played, "p2.x"), samples(two.played, "p2.x"));
  const auto again = fit_outline(std::vector{wind_first});
  const auto first = fit_outline(std::vector{unseen(kWindy)});
  EXPECT_EQ(std::get<ArxModel>(again->model.dynamics).theta, std::get<ArxModel>(first->model.dynamics).theta);
}

TEST(Validation, PredictionsAreInPixelsFrameByFrame) {
  const Recording recording = unseen(kCalm);
  const OutlineJudgement out = validated(calm_model(), recording, {.fidelity = false});
  ASSERT_EQ(out.predicted.size(), 4u);
  EXPECT_EQ(out.predicted[0].steps, 1);
  const Recording& next = out.predicted[0].recording;
  ASSERT_EQ(next.rows(), recording.rows());
  EXPECT_TRUE(std::isnan(samples(next, "p2.y")[0]));
  double error = 0;
  for (std::size_t row = 50; row < 600; ++row) {
    error = std::max(error, std::abs(samples(next, "p2.y")[row] - samples(recording, "p2.y")[row]));
  }
  // The tip's shock is 0.0154 heights of about 200 pixels; 3 pixels is one of them, five bound 550 frames.
  EXPECT_LT(error, 5 * 0.0154 * 200);
  EXPECT_GT(error, 0);
}

TEST(Validation, AFreeRunWithoutInputIsTheMeanShapeAndPlayIsNot) {
  const OutlineJudgement out = validated(calm_model(), unseen(kCalm), {.fidelity = false});
  const auto spread = [](const Recording& recording) {
    std::vector<double> heights;
    for (std::size_t row = 300; row < recording.rows(); ++row) {
      heights.push_back(samples(recording, "p2.y")[row] - samples(recording, "base.y")[row]);
    }
    const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
    return *high - *low;
  };
  Recording with_base = unseen(kCalm);
  const Recording units = to_model_units(with_base, *outline_layout(with_base), 200);
  for (const char* name : {"base.x", "base.y"})
    with_base.channels.push_back(units.channels[*find_channel(units, name)]);
  const OutlineJudgement based = validated(calm_model(), with_base, {.fidelity = false});
  EXPECT_LT(spread(based.predicted[3].recording), 1e-3);
  EXPECT_GT(spread(based.played), 10);
  EXPECT_EQ(out.figures.steps.back(), kFreeRun);
}

TEST(Validation, PlayingFreelyIsLikeTheRealThing) {
  const OutlineJudgement out = validated(calm_model(), unseen(kCalm));
  ASSERT_TRUE(out.fidelity);
  EXPECT_LT(out.fidelity->log_spectral_distance.value, 2 * out.fidelity->log_spectral_distance.floor);
  EXPECT_LT(out.fidelity->energy_distance.value, 0.05);
  EXPECT_EQ(out.held_share, 0);
  EXPECT_LT(out.self_intersection_rate, 0.05);
}

TEST(Validation, FramesOutOfSightHaveAPlayButNoPrediction) {
  Recording recording = unseen(kCalm);
  for (Channel& channel : recording.channels) {
    for (std::size_t row = 100; row < 150; ++row) channel.samples[row] = std::numeric_limits<double>::quiet_NaN();
  }
  const OutlineJudgement out = validated(calm_model(), recording, {.fidelity = false});
  EXPECT_TRUE(std::isnan(samples(out.predicted[0].recording, "p1.x")[120]));
  EXPECT_FALSE(std::isnan(samples(out.played, "p1.x")[120]));
}

TEST(Validation, ARecordingWithItsOwnKnotsIsExpressedInTheModels) {
  const Recording recording = unseen(kCalm);
  const auto other_knots = clamped_knots(std::vector<double>{0.45, 0.55});
  const Reknotted own = with_knots(recording, *outline_layout(recording), other_knots);
  const OutlineJudgement same = validated(calm_model(), recording, {.fidelity = false});
  const OutlineJudgement other = validated(calm_model(), own.recording, {.fidelity = false});
  EXPECT_EQ(other.warnings.size(), 1u);
  EXPECT_NEAR(other.figures.overlap[0], same.figures.overlap[0], 0.02);
  EXPECT_EQ(outline_layout(other.predicted[0].recording)->knots, outline_layout(recording)->knots);
}

// A flame that is out is not seen; a play that goes on there is not held against it.
TEST(Validation, WhatIsNotSeenIsNotJudged) {
  Recording gone = unseen(kWindy);
  const std::vector<double> wind = gone.channels[*find_channel(gone, "wind")].samples;
  for (Channel& channel : gone.channels) {
    for (std::size_t row = 0; channel.name != "wind" && row < wind.size(); ++row) {
      if (row % 600 > 300) channel.samples[row] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  auto& blown = gone.channels[*find_channel(gone, "wind")].samples;
  for (std::size_t row = 0; row < blown.size(); ++row) {
    if (row % 600 > 300) blown[row] = 0;
  }
  const OutlineJudgement whole = validated(windy_model(), unseen(kWindy));
  const OutlineJudgement part = validated(windy_model(), gone);
  ASSERT_TRUE(whole.fidelity && part.fidelity);
  EXPECT_LT(part.fidelity->energy_distance.value, whole.fidelity->energy_distance.value + 0.02);
}

TEST(Validation, AModelSaysWhetherItsOutlinesFollowedTheirUnderside) {
  const auto saying = [](const std::vector<std::string>& words) {
    std::vector<Recording> recordings;
    for (const std::string& word : words) {
      recordings.push_back(made::outline_recording({.rows = 400, .seed = recordings.size() + 1}));
      if (!word.empty()) recordings.back().attributes.push_back({"underside", word});
    }
    return fit_outline(recordings)->model.training.underside;
  };
  EXPECT_EQ(saying({"1", "1"}), true);
  EXPECT_EQ(saying({"0"}), false);
  EXPECT_EQ(saying({"0", "1"}), std::nullopt);
  EXPECT_EQ(saying({"1", ""}), std::nullopt);
  EXPECT_EQ(saying({"perhaps"}), std::nullopt);
}

TEST(Validation, AnotherMicrophonesGainIsTakenFromItsOwnGusts) {
  Recording quiet = unseen(kWindy);
  for (double& wind : quiet.channels[*find_channel(quiet, "wind")].samples) wind *= 0.1;
  const double trained = validated(windy_model(), quiet, {.fidelity = false}).figures.tip_fit_percent.back();
  const double own =
      validated(windy_model(), quiet, {.own_input_scale = true, .fidelity = false}).figures.tip_fit_percent.back();
  EXPECT_GT(own, trained + 20);
}

TEST(Validation, ARateWithinAThousandthOfTheModelsIsTheModels) {
  Recording recording = unseen(kCalm);
  recording.rate_hz *= 1.0005;
  const OutlineJudgement out = validated(calm_model(), recording);
  EXPECT_TRUE(out.fidelity);
  EXPECT_TRUE(out.warnings.empty());
}

TEST(Validation, AShortRecordingHasNoFidelityAndSaysSo) {
  const OutlineJudgement out = validated(calm_model(), slice(unseen(kCalm), 0, 30));
  EXPECT_FALSE(out.fidelity);
  ASSERT_EQ(out.warnings.size(), 1u);
  EXPECT_NE(out.warnings[0].find("no fidelity figures"), std::string::npos);
}

TEST(Validation, WhatDoesNotFitTheModelIsRefused) {
  Recording other = unseen(kCalm);
  EXPECT_EQ(judge_outline(windy_model(), other).error().message,
            "made 7: there is no input wind, which the model is driven by");
  other.rate_hz = 25;
  EXPECT_NE(judge_outline(calm_model(), other).error().message.find("samples a second"), std::string::npos);
  made::OutlineRecipe eight = kCalm;
  eight.points = 8;
  EXPECT_EQ(judge_outline(calm_model(), unseen(eight)).error().message,
            "made 7: has 8 control points, the model 6; capture it with --points 6");
  Model plain = calm_model();
  plain.view = PlainView{};
  EXPECT_NE(judge_outline(plain, unseen(kCalm)).error().message.find("not an outline model"), std::string::npos);
}

}  // namespace
}  // namespace wisp::validation_test
