#include "learn/outline/outline_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "base/statistics.hpp"
#include "learn/outline/made_outline.hpp"
#include "learn/outline/outline_knots.hpp"
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
  const OutlineFit fit = learned({.rows = 20000}, {.order = 2});
  const int tip = static_cast<int>(index_of(fit.model, "p2.x"));
  // The standard error of an AR(2) coefficient is near sqrt((1 − lag2²)/n) = 0.005; four of those.
  EXPECT_NEAR(arx(fit).a(tip, tip)[0], -1.5, 0.02);
  EXPECT_NEAR(arx(fit).a(tip, tip)[1], 0.7, 0.02);
  EXPECT_NEAR(arx(fit).a(tip, tip + 1)[0], 0, 0.02);
  EXPECT_TRUE(fit.summary.usable.verdict) << fit.summary.usable.reason;
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
  EXPECT_NEAR(mean_height_pixels(recording, layout, {}), unit, 1e-9);
}

TEST(Outline, AScaleThatIsGivenIsTaken) {
  const OutlineFit fit = learned({.rows = 500}, {.pixels_per_unit = 100});
  EXPECT_EQ(std::get<OutlineView>(fit.model.view).pixels_per_unit, 100);
}

TEST(Outline, PlayingFreelyItMovesAsMuchAsTheRecording) {
  const OutlineFit fit = learned({.rows = 2000});
  for (double ratio : fit.summary.sd_ratio) EXPECT_NEAR(ratio, 1, 0.05);
  EXPECT_TRUE(fit.summary.variance_matched);
}

TEST(Outline, ResidualsHaveTheShocksSizeWithin95Percent) {
  const OutlineFit fit = learned({.rows = 20000}, {.order = 2});
  const std::size_t tip = index_of(fit.model, "p2.x");
  const double true_sd = (0.3 + made::resting_y(2, 6)) * 0.01 * 200 / fit.summary.pixels_per_unit;
  // The base's own small motion is taken off every point: it adds (0.1/1.54)² of variance at most.
  EXPECT_NEAR(fit.summary.residuals[tip].sd, true_sd, 0.02 * true_sd);
  EXPECT_LT(fit.summary.residuals[tip].sd_ci95[0], fit.summary.residuals[tip].sd);
  EXPECT_GT(fit.summary.residuals[tip].sd_ci95[1], fit.summary.residuals[tip].sd);
  // χ² with n degrees of freedom: about ±1.96/sqrt(2n).
  EXPECT_NEAR(fit.summary.residuals[tip].sd_ci95[1] / fit.summary.residuals[tip].sd, 1 + 1.96 / std::sqrt(2 * 2e4),
              1e-3);
}

TEST(Outline, ControlPointsAreShakenTogether) {
  const made::OutlineRecipe recipe{.rows = 2000};
  const Recording real = made::outline_recording(recipe);
  const OutlineLayout layout = *outline_layout(real);
  const Recording units = to_model_units(real, layout, 200);
  const double wanted = correlation(samples(units, "p2.x"), samples(units, "p3.x"));
  ASSERT_GT(wanted, 0.5);
  // Twelve channels that each move by themselves too need as many shocks.
  const auto matched = synthesize(learned(recipe, {.shared_shocks = 10}).model, {.rows = 20000});
  EXPECT_NEAR(correlation(samples(matched->recording, "p2.x"), samples(matched->recording, "p3.x")), wanted, 0.05);
  const auto apart = synthesize(learned(recipe, {.noise = OutlineNoise::kIndependent}).model, {.rows = 20000});
  EXPECT_NEAR(correlation(samples(apart->recording, "p2.x"), samples(apart->recording, "p3.x")), 0, 0.1);
}

// A sluggish point beside a quick one: with the residuals' own covariance they drift apart, because what shakes both
// alike moves them unlike; matched shocks keep the recording's correlation.
TEST(Outline, PointsOfDifferentDynamicsStayTogether) {
  Recording real = made::outline_recording({.rows = 3000, .own_share = 0.02});
  for (const char* name : {"p3.x", "p3.y"}) {
    auto& sluggish = real.channels[*find_channel(real, name)].samples;
    for (std::size_t t = 1; t < sluggish.size(); ++t) sluggish[t] = 0.8 * sluggish[t - 1] + 0.2 * sluggish[t];
  }
  const Recording units = to_model_units(real, *outline_layout(real), 200);
  const double wanted = correlation(samples(units, "p2.x"), samples(units, "p3.x"));
  const auto played = [&](OutlineNoise noise) {
    const auto fit = fit_outline(std::vector{real}, {.noise = noise, .shared_shocks = 6});
    const auto play = synthesize(fit->model, {.rows = 20000});
    return correlation(samples(play->recording, "p2.x"), samples(play->recording, "p3.x"));
  };
  const double matched = std::abs(played(OutlineNoise::kMatched) - wanted);
  const double residual = std::abs(played(OutlineNoise::kResidual) - wanted);
  EXPECT_LT(matched, 0.05);
  EXPECT_GT(residual, 2 * matched);
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
  EXPECT_TRUE(fit.summary.refitted);
  ASSERT_TRUE(fit.summary.held_out);
  EXPECT_EQ(fit.summary.held_out->steps, kJudgedSteps);
  EXPECT_GT(fit.summary.held_out->channels[4].fit_percent[0], 60);
}

TEST(Outline, WithoutRefittingTheHeldOutPartIsNotLearned) {
  const made::OutlineRecipe recipe{.rows = 1000};
  Recording recording = made::outline_recording(recipe);
  Recording changed = recording;
  for (Channel& channel : changed.channels) {
    for (std::size_t row = 700; row < 1000; ++row) channel.samples[row] += 3 * std::sin(0.7 * static_cast<double>(row));
  }
  const OutlineRecipe options{.refit = false, .pixels_per_unit = 200};
  const auto one = fit_outline(std::vector{recording}, options);
  const auto other = fit_outline(std::vector{changed}, options);
  EXPECT_EQ(arx(*one).theta, arx(*other).theta);
  EXPECT_EQ(arx(*one).noise.mixing, arx(*other).noise.mixing);
}

TEST(Outline, TheCutFallsOnAnEpisodesBoundaryWhereOneIsNear) {
  Recording recording = made::outline_recording({.rows = 1000});
  for (std::size_t row = 0; row < 1000; ++row) recording.episode_ids.push_back(row < 660 ? 0 : 1);
  const auto fit = fit_outline(std::vector{recording}, {.refit = false});
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

TEST(Outline, CostsAreThePapers) {
  const made::OutlineRecipe calm{.points = 8, .rows = 600};
  const made::OutlineRecipe windy{.points = 8, .rows = 600, .wind = true};
  const auto multiply_adds = [](const OutlineFit& fit) {
    const auto cost = count_operations(fit.model);
    return cost ? cost->multiply_adds_per_frame : 0;
  };
  EXPECT_EQ(multiply_adds(learned(calm)), 128);
  EXPECT_EQ(multiply_adds(learned(windy, {.one_sided = true, .noise = OutlineNoise::kMatched})), 192);
  // By its orders 256; but the base mirrored is the base turned about, so that its x and y do not drive each other, and
  // those 16 coefficients vanish.
  const OutlineFit both = learned(windy, {.noise = OutlineNoise::kMatched});
  int coefficients = 0;
  for (int i = 0; i < 16; ++i) coefficients += both.summary.orders.row_size(i);
  EXPECT_EQ(coefficients, 256);
  EXPECT_EQ(multiply_adds(both), 240);
  // Resampled residuals hold what more lags and the other coordinate would say.
  EXPECT_EQ(multiply_adds(learned(windy, {.light = true})), 144);
  // Every coordinate hears two lags of 14, and of the wind from either side four, and two of its root and its square.
  EXPECT_EQ(multiply_adds(learned(windy)), 16 * (2 * 14 + 2 * 8));
}

TEST(Outline, MoreCouplingMakesMoreCoefficients) {
  EXPECT_EQ(learned({.rows = 2000}, {.order = 2, .coupling = OutlineCoupling::kBand}).summary.orders.row_size(4), 12);
  // All points but the last, which mirrors the first.
  EXPECT_EQ(learned({.rows = 2000}, {.order = 2, .coupling = OutlineCoupling::kFull}).summary.orders.row_size(4), 20);
}

TEST(Outline, TheSameRecordingGivesTheSameModel) {
  const auto one = model_bytes(learned({.rows = 800}).model);
  const auto two = model_bytes(learned({.rows = 800}).model);
  EXPECT_EQ(*one, *two);
}

TEST(Outline, ThreeFramesAreTooFew) {
  const Recording recording = slice(made::outline_recording({.rows = 100}), 0, 3);
  EXPECT_EQ(
      refused({recording}),
      "made 1: has 3 complete rows, and 8 coefficients an output need at least 24; record longer or lower the order");
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
  const auto fit = fit_outline(std::vector{recording}, {.order = 2});
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_GT(fit->summary.unsteadiness, 0.9);
  EXPECT_FALSE(fit->summary.usable.verdict);
  EXPECT_NE(fit->summary.usable.reason.find("picked at random"), std::string::npos) << fit->summary.usable.reason;
  EXPECT_LT(learned({.rows = 1500}, {.order = 2}).summary.unsteadiness, 0.5);
}

// Every other point moves as it does, so that the median channel is predicted.
TEST(Outline, ATipThatIsNoiseIsNotUsable) {
  Recording recording = made::outline_recording({.points = 10, .rows = 1500});
  std::mt19937_64 random(3);
  std::normal_distribution<double> gauss;
  for (const char* name : {"p4.x", "p4.y", "p5.x", "p5.y"}) {
    auto& samples = recording.channels[*find_channel(recording, name)].samples;
    const double sd = deviation(samples);
    for (double& value : samples) value += 0.8 * sd * gauss(random);
  }
  const auto fit = fit_outline(std::vector{recording});
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_FALSE(fit->summary.usable.verdict);
  EXPECT_NE(fit->summary.usable.reason.find("where the tip is next"), std::string::npos) << fit->summary.usable.reason;
  EXPECT_GT(fit->summary.held_out->channels[2].fit_percent[0], 40);
}

TEST(Outline, AFewDozenFramesAreNotUsableAndSaySo) {
  const OutlineFit fit = learned({.rows = 45}, {.order = 2});
  EXPECT_FALSE(fit.summary.usable.verdict);
  EXPECT_NE(fit.summary.usable.reason.find("45 frames"), std::string::npos) << fit.summary.usable.reason;
}

TEST(Outline, OptionsOutOfRangeAreRefused) {
  const std::vector recordings{made::outline_recording({.rows = 100})};
  EXPECT_EQ(refused(recordings, {.order = -1}), "the order is -1, expected 0 (as fits the noise) to 64");
  EXPECT_EQ(refused(recordings, {.delay = -1}), "the delay is -1, expected 0 to 1000 frames");
  EXPECT_EQ(refused(recordings, {.holdout = 0.95}), "the held-out share is 0.95, expected 0 to 0.9");
  EXPECT_EQ(refused(recordings, {.shared_shocks = 0}), "the number of shared shocks is 0, expected 1 to 64");
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
