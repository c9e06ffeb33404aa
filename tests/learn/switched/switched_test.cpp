#include "learn/switched/switched_fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "learn/arx/fit/arx_fit.hpp"
#include "learn/numeric/lyapunov.hpp"
#include "learn/switched/made_switched.hpp"
#include "learn/switched/switched_prediction.hpp"

namespace wisp::switched_test {
namespace {

using testing::HasSubstr;

const ChannelChoice kChannels{{"u"}, {"y"}};

SwitchedOptions options_of(Switching switching, int modes = 3) {
  return {.orders = first_order(), .switching = switching, .modes = modes, .max_modes = 4, .starts = 6};
}

SwitchedFit fit_of(const Recording& recording, const SwitchedOptions& options) {
  auto fit = fit_switched({&recording, 1}, kChannels, options);
  EXPECT_TRUE(fit) << fit.error().message;
  return std::move(fit).value();
}

// The learned mode that is nearest to a true one.
std::size_t match_of(const SwitchedArxModel& model, const MadeMode& truth) {
  std::size_t best = 0;
  double least = 1e300;
  for (std::size_t k = 0; k < model.modes.size(); ++k) {
    const double a = -model.modes[k].theta[0][0] - truth.a, b = model.modes[k].theta[0][1] - truth.b;
    if (a * a + b * b >= least) continue;
    least = a * a + b * b;
    best = k;
  }
  return best;
}

// Largest error of a coefficient in its standard errors, and the share of rows whose mode was told.
struct Recovery {
  double worst = 0;
  double share = 0;
};

Recovery recovery_of(const SwitchedFit& fit, const MadeSwitched& made, const std::vector<MadeMode>& truth) {
  Recovery out;
  std::vector<int> match;
  for (const MadeMode& mode : truth) {
    const std::size_t k = match_of(fit.model, mode);
    const ArxMode& found = fit.model.modes[k];
    match.push_back(static_cast<int>(k));
    out.worst = std::max({out.worst, std::abs(-found.theta[0][0] - mode.a) / found.std_error[0][0],
                          std::abs(found.theta[0][1] - mode.b) / found.std_error[0][1]});
  }
  double right = 0;
  for (std::size_t t = 1; t < made.modes.size(); ++t) right += match[made.modes[t]] == fit.modes[0][t];
  out.share = right / static_cast<double>(made.modes.size() - 1);
  return out;
}

double mean_likelihood(const SwitchedArxModel& model, const Recording& recording) {
  const auto rows = row_log_likelihoods(model, {&recording, 1}, kChannels);
  EXPECT_TRUE(rows) << rows.error().message;
  double sum = 0;
  for (double row : *rows) sum += row;
  return sum / static_cast<double>(rows->size());
}

TEST(SwitchedFit, ThreeRegionsAreFoundAgain) {
  const MadeSwitched made = made_regions(2000, 1);
  const SwitchedFit fit = fit_of(made.recording, options_of(Switching::kRegions));
  const Recovery recovery = recovery_of(fit, made, kMadeRegions);
  EXPECT_LT(recovery.worst, 3);
  EXPECT_GT(recovery.share, 0.95);
  EXPECT_TRUE(fit.summary.usable.verdict) << fit.summary.usable.reason;
}

TEST(SwitchedFit, ThreeModesOfAMarkovChainAreFoundAgain) {
  const MadeSwitched made = made_chain(2000, 1);
  const SwitchedFit fit = fit_of(made.recording, options_of(Switching::kMarkov));
  const Recovery recovery = recovery_of(fit, made, kMadeChain);
  EXPECT_LT(recovery.worst, 3);
  EXPECT_GT(recovery.share, 0.95);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(fit.model.transitions[k * 4], 0.95, 0.025);
  EXPECT_TRUE(fit.summary.usable.verdict) << fit.summary.usable.reason;
}

TEST(SwitchedFit, RowsHeldOutChooseTheNumberOfModes) {
  const SwitchedFit regions = fit_of(made_regions(1500, 2).recording, options_of(Switching::kRegions, 0));
  const SwitchedFit markov = fit_of(made_chain(1500, 2).recording, options_of(Switching::kMarkov, 0));
  EXPECT_EQ(regions.model.modes.size(), 3U);
  EXPECT_EQ(markov.model.modes.size(), 3U);
}

TEST(SwitchedFit, OfALinearSystemASingleModelIsAsGoodAndTheVerdictSaysSo) {
  const MadeSwitched made = made_linear(1500, 3);
  for (Switching switching : {Switching::kRegions, Switching::kMarkov}) {
    const SwitchedFit fit = fit_of(made.recording, options_of(switching, 0));
    EXPECT_EQ(fit.model.modes.size(), 1U);
    EXPECT_FALSE(fit.summary.usable.verdict);
    EXPECT_THAT(fit.summary.usable.reason, HasSubstr("use an ARX model"));
    EXPECT_FALSE(fit_of(made.recording, options_of(switching, 2)).summary.usable.verdict);
  }
}

TEST(SwitchedFit, TheWrongKindOfModelLosesOnHeldOutData) {
  const MadeSwitched regions = made_regions(2000, 4), chain = made_chain(2000, 4);
  const MadeSwitched new_regions = made_regions(1000, 5), new_chain = made_chain(1000, 5);
  const auto judge = [](const Recording& learned, const Recording& judged, Switching switching) {
    return mean_likelihood(fit_of(learned, options_of(switching)).model, judged);
  };
  ArxOptions options;
  options.orders = first_order();
  const auto judge_arx = [&](const Recording& learned, const Recording& judged) {
    return mean_likelihood(switched_of(fit_arx({&learned, 1}, kChannels, options)->model), judged);
  };
  const double right = judge(regions.recording, new_regions.recording, Switching::kRegions);
  EXPECT_GT(right, judge(regions.recording, new_regions.recording, Switching::kMarkov) + 0.1);
  EXPECT_GT(right, judge_arx(regions.recording, new_regions.recording) + 0.5);
  const double chained = judge(chain.recording, new_chain.recording, Switching::kMarkov);
  EXPECT_GT(chained, judge(chain.recording, new_chain.recording, Switching::kRegions) + 0.1);
  EXPECT_GT(chained, judge_arx(chain.recording, new_chain.recording) + 0.5);
}

TEST(SwitchedFit, RowsWithAMissingSampleAreLeftOutAndNothingCrossesThem) {
  MadeSwitched made = made_chain(2000, 6);
  for (std::size_t t = 50; t < 2000; t += 400) made.recording.channels[1].samples[t] = std::nan("");
  const SwitchedFit fit = fit_of(made.recording, options_of(Switching::kMarkov));
  EXPECT_EQ(fit.summary.samples_used, 1999U - 2 * 5);
  EXPECT_EQ(fit.modes[0][50], -1);
  EXPECT_EQ(fit.modes[0][51], -1);
  EXPECT_LT(recovery_of(fit, made, kMadeChain).worst, 4);
}

TEST(SwitchedFit, TheSameSeedGivesTheSameModel) {
  const MadeSwitched made = made_regions(600, 7);
  const auto options = options_of(Switching::kRegions, 2);
  const SwitchedFit one = fit_of(made.recording, options), two = fit_of(made.recording, options);
  EXPECT_EQ(one.model.regions, two.model.regions);
  EXPECT_EQ(one.model.modes[0].theta, two.model.modes[0].theta);
}

TEST(SwitchedFit, RefusesWhatItCannotFitByName) {
  const MadeSwitched made = made_regions(60, 8);
  const auto error = [&](const SwitchedOptions& options, const ChannelChoice& channels = kChannels) {
    const auto fit = fit_switched({&made.recording, 1}, channels, options);
    return fit ? std::string("no error") : fit.error().message;
  };
  EXPECT_THAT(error(options_of(Switching::kRegions, 65)), HasSubstr("the number of modes is 65, expected 1 to 64"));
  EXPECT_THAT(error(options_of(Switching::kRegions, 20)), HasSubstr("59 usable rows, expected at least"));
  EXPECT_THAT(error(options_of(Switching::kRegions), {{"wind"}, {"y"}}), HasSubstr("has no channel 'wind'"));
  auto options = options_of(Switching::kRegions);
  options.holdout = 1;
  EXPECT_THAT(error(options), HasSubstr("held out"));
  EXPECT_THAT(fit_switched({}, kChannels, options_of(Switching::kMarkov)).error().message, HasSubstr("no recording"));
}

// Without noise a simulation from the first measured sample is the recording.
TEST(SwitchedPrediction, OfANoiselessRecordingIsTheRecording) {
  const auto noiseless = record_switched(kMadeRegions, 200, 9, 0.0, [](int, double y, double u, double) {
    return 4 * y - u + 10 < 0 ? 0 : 5 * y + u - 6 < 0 ? 1 : 2;
  });
  SwitchedArxModel model;
  model.orders = first_order();
  model.output_mean = model.input_mean = {0};
  for (const MadeMode& mode : kMadeRegions) model.modes.push_back({{{-mode.a, mode.b}}, {}, {mode.c}, {0.1}});
  model.regions = {-10, -4, 1, 0, 0, 0, -6, 5, 1};
  for (int steps : {1, 5, kFreeRun}) {
    const auto predicted = predict_switched(model, noiseless.recording, kChannels, steps);
    ASSERT_TRUE(predicted) << predicted.error().message;
    const std::size_t first = steps == kFreeRun ? 1 : static_cast<std::size_t>(steps);
    EXPECT_TRUE(std::isnan((*predicted)[0][first - 1]));
    for (std::size_t t = first; t < 200; ++t) {
      ASSERT_NEAR((*predicted)[0][t], noiseless.recording.channels[1].samples[t], 1e-9) << steps << " " << t;
    }
  }
}

// Two poles of that radius at plus and minus an angle.
ArxMode turning_mode(double radius, double angle) {
  return {{{-2 * radius * std::cos(angle), radius * radius}}, {}, {0}, {0.1}};
}

SwitchedArxModel turning_model(const std::vector<ArxMode>& modes) {
  SwitchedArxModel model;
  model.orders = {OrderMatrix(1, 1, 2), OrderMatrix(1, 0), OrderMatrix(1, 0)};
  model.output_mean = {0};
  model.modes = modes;
  model.regions.assign(modes.size() * 3, 0.0);
  return model;
}

TEST(CommonLyapunov, IsFoundWhereModesAreAlike) {
  auto model = turning_model({turning_mode(0.9, 0.5), turning_mode(0.8, 0.6), turning_mode(0.85, 0.4)});
  model.lyapunov = find_common_lyapunov(model);
  EXPECT_EQ(model.lyapunov.size(), 1U);
  EXPECT_TRUE(check(model));
}

// Each is stable; one step of one and one of the other grow together, so there can't be a function.
TEST(CommonLyapunov, IsNotFoundWhereSwitchingDiverges) {
  const auto model = turning_model({turning_mode(0.98, 0.4), turning_mode(0.98, 2.6)});
  double before = 1, now = 1;
  for (int t = 0; t < 400; ++t) {
    const auto& theta = model.modes[t % 2].theta[0];
    const double next = -theta[0] * now - theta[1] * before;
    before = now;
    now = next;
  }
  EXPECT_GT(std::abs(now) + std::abs(before), 1e6);
  EXPECT_TRUE(find_common_lyapunov(model).empty());
}

}  // namespace
}  // namespace wisp::switched_test
