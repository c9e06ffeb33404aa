#include "learn/outline/outline_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "base/statistics.hpp"
#include "learn/outline/made_outline.hpp"
#include "learn/outline/outline_preparation.hpp"
#include "learn/outline/outline_synthesis.hpp"
#include "model/bspline.hpp"
#include "wisp/model/file.hpp"
#include "wisp/run/cost.hpp"

namespace wisp::outline_test {
namespace {

OutlineFit learned(const made::OutlineRecipe& recipe, const OutlineRecipe& options = {}) {
  const std::vector recordings{made::outline_recording(recipe)};
  auto fit = fit_outline(recordings, options);
  EXPECT_TRUE(fit) << (fit ? "" : fit.error().message);
  return *std::move(fit);
}

std::string refused(const std::vector<Recording>& recordings, const OutlineRecipe& options = {}) {
  const auto fit = fit_outline(recordings, options);
  EXPECT_FALSE(fit);
  return fit ? "" : fit.error().message;
}

const ArxModel& arx(const OutlineFit& fit) { return std::get<ArxModel>(fit.model.dynamics); }

std::size_t index_of(const Model& model, const std::string& output) {
  const auto at = std::find_if(model.outputs.begin(), model.outputs.end(),
                               [&](const Output& candidate) { return candidate.name == output; });
  return static_cast<std::size_t>(at - model.outputs.begin());
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  const auto n = static_cast<double>(a.size());
  for (std::size_t t = 0; t < a.size(); ++t) {
    sa += a[t];
    sb += b[t];
    saa += a[t] * a[t];
    sbb += b[t] * b[t];
    sab += a[t] * b[t];
  }
  return (sab - sa * sb / n) / std::sqrt((saa - sa * sa / n) * (sbb - sb * sb / n));
}

const std::vector<double>& samples(const Recording& recording, const char* name) {
  return recording.channels[*find_channel(recording, name)].samples;
}

TEST(Outline, TheDynamicsThatMadeARecordingAreFound) {
  const OutlineFit fit = learned({.rows = 20000}, {.paper = 2});
  const int tip = static_cast<int>(index_of(fit.model, "p2.x"));
  // The standard error of an AR(2) coefficient is near sqrt((1 − lag2²)/n) = 0.005; four of those.
  EXPECT_NEAR(arx(fit).a(tip, tip)[0], -1.5, 0.02);
  EXPECT_NEAR(arx(fit).a(tip, tip)[1], 0.7, 0.02);
  EXPECT_NEAR(arx(fit).a(tip, tip + 1)[0], 0, 0.02);
}

TEST(Outline, TheModelIsValidAndSaysWhatItIs) {
  const OutlineFit fit = learned({.rows = 600}, {.name = "made flame"});
  EXPECT_TRUE(check(fit.model)) << check(fit.model).error().message;
  EXPECT_EQ(fit.model.name, "made flame");
  EXPECT_EQ(fit.model.rate_hz, 30);
  EXPECT_EQ(fit.model.outputs.size(), 12u);
  EXPECT_TRUE(fit.model.inputs.empty());
  EXPECT_EQ(std::get<OutlineView>(fit.model.view).knots.size(), 10u);
  EXPECT_EQ(fit.model.training.sources, std::vector<std::string>{"made 1"});
  EXPECT_EQ(fit.model.training.usable.verdict, fit.summary.usable.verdict);
}

TEST(Outline, MeanHeightIsOneInTheModelsUnits) {
  const made::OutlineRecipe recipe{.rows = 2000};
  const OutlineFit fit = learned(recipe);
  const Recording recording = made::outline_recording(recipe);
  const OutlineLayout layout = *outline_layout(recording);
  const double unit = std::get<OutlineView>(fit.model.view).pixels_per_unit;
  EXPECT_NEAR(mean(heights_pixels(recording, layout, {})), unit, 1e-9);
}

TEST(Outline, AScaleThatIsGivenIsTaken) {
  const OutlineFit fit = learned({.rows = 500}, {.pixels_per_unit = 100});
  EXPECT_EQ(std::get<OutlineView>(fit.model.view).pixels_per_unit, 100);
}

TEST(Outline, PlayingFreelyItMovesAsMuchAsTheRecording) {
  const OutlineFit fit = learned({.rows = 2000});
  for (double ratio : fit.summary.trial.sd_ratio) EXPECT_NEAR(ratio, 1, 0.25);
  EXPECT_TRUE(fit.summary.usable.verdict) << fit.summary.usable.reason;
}

TEST(Outline, APlayThatMovesFarLessOrMoreThanTheRecordingIsNotUsable) {
  OutlineSummary summary = learned({.rows = 2000}).summary;
  for (const auto& [ratio, missed] : {std::pair{0.65, "still"}, {0.75, ""}, {1.3, ""}, {1.5, "wild"}}) {
    summary.trial.sd_ratio.assign(summary.trial.sd_ratio.size(), ratio);
    std::string code;
    const Usable verdict = outline_verdict(summary, &code);
    EXPECT_EQ(verdict.verdict, code.empty()) << verdict.reason;
    EXPECT_EQ(code, missed);
    EXPECT_NE(verdict.reason.find("playing freely it moves"), std::string::npos) << verdict.reason;
  }
}

TEST(Outline, TheEndsOfTheBaseStayMirrorImages) {
  const auto play = synthesize(learned({.rows = 600}).model, {.rows = 500});
  for (std::size_t t = 0; t < 500; ++t) {
    EXPECT_NEAR(samples(play->recording, "p0.x")[t], -samples(play->recording, "p5.x")[t], 1e-5);
  }
}

TEST(Outline, RangesHoldEverythingThatWasSeen) {
  const made::OutlineRecipe recipe{.rows = 1000};
  const OutlineFit fit = learned(recipe);
  const Recording units = to_model_units(made::outline_recording(recipe),
                                         *outline_layout(made::outline_recording(recipe)), fit.summary.pixels_per_unit);
  for (const Output& output : fit.model.outputs) {
    const auto& seen = samples(units, output.name.c_str());
    EXPECT_LE(output.lowest, *std::min_element(seen.begin(), seen.end()) + 1e-12);
    EXPECT_GE(output.highest, *std::max_element(seen.begin(), seen.end()) - 1e-12);
  }
}

TEST(Outline, AStillBaseIsNoObstacle) {
  Recording recording = made::outline_recording({.rows = 1000});
  for (const char* name : {"p0.y", "p5.y"}) {
    for (double& y : recording.channels[*find_channel(recording, name)].samples) y = 400;
  }
  const auto fit = fit_outline(std::vector{recording});
  ASSERT_TRUE(fit) << fit.error().message;
  const auto play = synthesize(fit->model, {.rows = 100});
  for (double y : samples(play->recording, "p0.y")) EXPECT_NEAR(y, 0, 1e-6);
}

TEST(Outline, TheLastPartIsHeldOutAndThenLearnedToo) {
  const OutlineFit fit = learned({.rows = 1000, .wind = true}, {.holdout = 0.3});
  EXPECT_EQ(fit.summary.rows_learned, 700u);
  EXPECT_EQ(fit.summary.rows_held_out, 300u);
  ASSERT_TRUE(fit.summary.held_out);
  EXPECT_EQ(fit.summary.held_out->steps, kJudgedSteps);
  EXPECT_GT(fit.summary.held_out->channels[4].fit_percent[0], 60);
}

TEST(Outline, TheCutFallsOnAnEpisodesBoundaryWhereOneIsNear) {
  Recording recording = made::outline_recording({.rows = 1000});
  for (std::size_t row = 0; row < 1000; ++row) recording.episode_ids.push_back(row < 660 ? 0 : 1);
  const auto fit = fit_outline(std::vector{recording});
  EXPECT_EQ(fit->summary.rows_learned, 660u);
}

TEST(Outline, MissingRowsAreLeftOut) {
  Recording recording = made::outline_recording({.rows = 1000});
  for (Channel& channel : recording.channels) {
    for (std::size_t row = 400; row < 450; ++row) channel.samples[row] = std::numeric_limits<double>::quiet_NaN();
  }
  const auto fit = fit_outline(std::vector{recording});
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->summary.rows_learned + fit->summary.rows_held_out, 950u);
}

TEST(Outline, ThePapersFlameCostsWhatThePaperSays) {
  const OutlineFit fit = learned({.points = 8, .rows = 600, .wind = true}, {.paper = 4});
  EXPECT_EQ(count_operations(fit.model)->multiply_adds_per_frame, 192);
  EXPECT_TRUE(std::get<OutlineView>(fit.model.view).shape.empty());
  EXPECT_TRUE(arx(fit).noise.resampled.empty());
}

// Two blocks of seven, and six lags of three functions of the wind: of its size for one kind, with its sign for the
// other.
TEST(Outline, SymmetricAndAntisymmetricComponentsDoNotHearEachOther) {
  const OutlineFit fit = learned({.points = 8, .rows = 900, .wind = true});
  const ShapeComponents& shape = std::get<OutlineView>(fit.model.view).shape;
  EXPECT_EQ(shape.symmetric, 7u);
  EXPECT_EQ(shape.antisymmetric, 7u);
  for (int i = 0; i < 14; ++i) {
    for (int j = 0; j < 14; ++j) EXPECT_EQ(arx(fit).orders.na(i, j), (i < 7) == (j < 7) ? 2 : 0);
    for (int k = 0; k < 6; ++k) EXPECT_EQ(arx(fit).orders.nb(i, k), (i < 7) == (k < 3) ? 6 : 0);
  }
  EXPECT_EQ(count_operations(fit.model)->multiply_adds_per_frame, 14 * (2 * 7 + 18));
}

TEST(Outline, ControlPointsMoveTogetherAsRecorded) {
  const made::OutlineRecipe recipe{.rows = 2000};
  const Recording real = made::outline_recording(recipe);
  const Recording units = to_model_units(real, *outline_layout(real), 200);
  const double wanted = correlation(samples(units, "p2.x"), samples(units, "p3.x"));
  ASSERT_GT(wanted, 0.5);
  const auto played = synthesize(learned(recipe).model, {.rows = 20000});
  EXPECT_NEAR(correlation(samples(played->recording, "p2.x"), samples(played->recording, "p3.x")), wanted, 0.1);
  const auto apart = synthesize(learned(recipe, {.paper = 4}).model, {.rows = 20000});
  EXPECT_NEAR(correlation(samples(apart->recording, "p2.x"), samples(apart->recording, "p3.x")), 0, 0.1);
}

// Whatever is played stays within the recorded range of widths, heights and leans.
TEST(Outline, NoPlayedOutlineCrossesItself) {
  const OutlineFit fit = learned({.rows = 900, .shock = 0.003, .wind = true});
  EXPECT_EQ(fit.summary.trial.crossed, 0);
}

TEST(Outline, TheSameRecordingGivesTheSameModel) {
  const auto one = model_bytes(learned({.rows = 800}).model);
  const auto two = model_bytes(learned({.rows = 800}).model);
  EXPECT_EQ(*one, *two);
}

TEST(Outline, ThreeFramesAreTooFew) {
  const Recording recording = slice(made::outline_recording({.rows = 100}), 0, 3);
  EXPECT_EQ(refused({recording}), "made 1: has 1 complete rows with their past, expected at least 30; record longer");
}

TEST(Outline, FramesInRandomOrderAreNotUsableAndSaySo) {
  Recording recording = made::outline_recording({.rows = 1500});
  std::vector<std::size_t> order(recording.rows());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(7));
  for (Channel& channel : recording.channels) {
    const std::vector<double> before = channel.samples;
    for (std::size_t row = 0; row < order.size(); ++row) channel.samples[row] = before[order[row]];
  }
  const auto fit = fit_outline(std::vector{recording});
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_GT(fit->summary.trial.unsteadiness, 0.9);
  EXPECT_FALSE(fit->summary.usable.verdict);
  EXPECT_NE(fit->summary.usable.reason.find("picked at random"), std::string::npos) << fit->summary.usable.reason;
  EXPECT_LT(learned({.rows = 1500}).summary.trial.unsteadiness, 0.5);
}

TEST(Outline, AFewDozenFramesAreNotUsableAndSaySo) {
  const OutlineFit fit = learned({.rows = 45}, {.paper = 1});
  EXPECT_FALSE(fit.summary.usable.verdict);
  EXPECT_NE(fit.summary.usable.reason.find("45 frames"), std::string::npos) << fit.summary.usable.reason;
}

TEST(Outline, OptionsOutOfRangeAreRefused) {
  const std::vector recordings{made::outline_recording({.rows = 100})};
  EXPECT_EQ(refused(recordings, {.paper = -1}), "paper is -1, expected 0 to 64");
  EXPECT_EQ(refused(recordings, {.holdout = 0.95}), "holdout is 0.95, expected 0 to 0.9");
}

TEST(Outline, AClipWithItsOwnKnotsIsExpressedInTheFirstOnes) {
  const Recording first = made::outline_recording({.points = 8, .rows = 600});
  const Recording second = made::outline_recording({.points = 8, .rows = 600, .seed = 2});
  const Reknotted own =
      with_knots(second, *outline_layout(second), clamped_knots(std::vector<double>{0.25, 0.45, 0.55, 0.75}));
  const auto fit = fit_outline(std::vector{first, own.recording});
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(std::get<OutlineView>(fit->model.view).knots, outline_layout(first)->knots);
  ASSERT_EQ(fit->summary.warnings.size(), 1u);
  EXPECT_NE(fit->summary.warnings[0].find("made 2: its knots are not the model's"), std::string::npos);
}

TEST(Outline, AClipInAnotherColourIsWarnedOf) {
  std::vector recordings{made::outline_recording({.rows = 600}), made::outline_recording({.rows = 600, .seed = 2}),
                         made::outline_recording({.rows = 600, .seed = 3})};
  recordings[0].attributes.push_back({"channel", "red"});
  recordings[1].attributes.push_back({"channel", "red"});
  const auto alike = fit_outline(recordings);
  ASSERT_TRUE(alike) << alike.error().message;
  EXPECT_TRUE(alike->summary.warnings.empty());
  recordings[1].attributes.back() = {"channel", "green"};
  const auto other = fit_outline(recordings);
  ASSERT_TRUE(other) << other.error().message;
  ASSERT_EQ(other->summary.warnings.size(), 1u);
  EXPECT_EQ(other->summary.warnings[0],
            "made 2: its outlines were found in green, those of made 1 in red, so that they are not as wide; capture "
            "both with the same --channel");
}

TEST(Outline, RecordingsOfDifferentOutlinesAreRefused) {
  const std::vector recordings{made::outline_recording({.rows = 200}),
                               made::outline_recording({.points = 8, .rows = 200, .seed = 2})};
  EXPECT_EQ(refused(recordings), "made 2: has 8 control points, but made 1 has 6; capture both with the same --points");
}

}  // namespace
}  // namespace wisp::outline_test
