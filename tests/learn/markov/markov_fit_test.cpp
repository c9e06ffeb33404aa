
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "learn/markov/made_markov.hpp"
#include "learn/markov/markov_rows.hpp"

namespace wisp::markov_fit_test {
namespace {

using testing::HasSubstr;

const ChannelChoice kChannels{{"u"}, {"y"}};

markov::Fitted fit_of(const Recording& recording, int modes = 3, ArxOrders orders = first_order()) {
  auto fit = markov::fit({&recording, 1}, kChannels, {.orders = std::move(orders), .modes = modes});
  EXPECT_TRUE(fit) << fit.error().message;
  return std::move(fit).value();
}

// The learned mode that is nearest to a true one.
std::size_t match_of(const SwitchedArxModel& model, const MadeMode& truth) {
  const auto distance = [&](const ArxMode& mode) {
    return std::hypot(-mode.theta[0][0] - truth.a, mode.theta[0][1] - truth.b);
  };
  const auto nearer = [&](const ArxMode& a, const ArxMode& b) { return distance(a) < distance(b); };
  return static_cast<std::size_t>(std::min_element(model.modes.begin(), model.modes.end(), nearer) -
                                  model.modes.begin());
}

// Largest error of a coefficient in its standard errors, and the share of rows whose mode was found.
struct Recovery {
  double worst = 0;
  double share = 0;
};

Recovery recovery_of(const markov::Fitted& fit, const MadeSwitched& made) {
  Recovery out;
  std::vector<int> match;
  for (const MadeMode& mode : kMadeChain) {
    match.push_back(static_cast<int>(match_of(fit.model, mode)));
    const ArxMode& found = fit.model.modes[static_cast<std::size_t>(match.back())];
    out.worst = std::max({out.worst, std::abs(-found.theta[0][0] - mode.a) / found.std_error[0][0],
                          std::abs(found.theta[0][1] - mode.b) / found.std_error[0][1]});
  }
  double right = 0;
  const auto found = markov::believe(fit.model, made.recording, kChannels)->likeliest();
  for (std::size_t t = 0; t < found.size(); ++t) right += match[made.modes[t + 1]] == found[t];
  out.share = right / static_cast<double>(made.modes.size() - 1);
  return out;
}

// Of two modes that take turns by chance, with shocks of 0.1 and 0.1 · `louder`.
markov::Fitted fit_of_turns(const MadeMode& quiet, const MadeMode& loud, double louder) {
  MadeSwitched made = record_switched({quiet, loud}, 3000, 1, 0.1, [](int mode, double, double, double chance) {
    return chance < 0.97 ? mode : 1 - mode;
  });
  auto& y = made.recording.channels[1].samples;
  const auto& u = made.recording.channels[0].samples;
  const std::vector<double> first = y;
  for (std::size_t t = 1; t < y.size(); ++t) {
    const MadeMode& mode = made.modes[t] == 1 ? loud : quiet;
    const double shock = first[t] - (mode.a * first[t - 1] + mode.b * u[t - 1] + mode.c);
    y[t] = mode.a * y[t - 1] + mode.b * u[t - 1] + mode.c + (made.modes[t] == 1 ? louder : 1) * shock;
  }
  return fit_of(made.recording, 2);
}

TEST(MarkovFit, ThreeModesAreFoundAgainFromEverySeed) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const MadeSwitched made = made_chain(2000, seed);
    const markov::Fitted fit = fit_of(made.recording);
    const Recovery recovery = recovery_of(fit, made);
    EXPECT_LT(recovery.worst, 4) << seed;  // of 30 coefficients
    EXPECT_GT(recovery.share, 0.95) << seed;
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(fit.model.transitions[k * 4], 0.95, 0.03) << seed;
    EXPECT_TRUE(fit.summary.usable.verdict) << fit.summary.usable.reason;
    EXPECT_TRUE(check(fit.model));
  }
}

TEST(MarkovFit, UnitsOfChannelsDoNotMatter) {
  MadeSwitched made = made_chain(1000, 1);
  const markov::Fitted one = fit_of(made.recording);
  for (double& u : made.recording.channels[0].samples) u *= 0x1p20;
  for (double& y : made.recording.channels[1].samples) y *= 0x1p-20;
  const markov::Fitted other = fit_of(made.recording);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(one.model.modes[k].theta[0][1], other.model.modes[k].theta[0][1] * 0x1p40, 1e-6);
    EXPECT_NEAR(one.model.modes[k].shock[0], other.model.modes[k].shock[0] * 0x1p20, 1e-6);
  }
}

TEST(MarkovFit, HeldOutRowsChooseTheNumberOfModes) {
  EXPECT_EQ(fit_of(made_chain(1500, 2).recording, 0).model.modes.size(), 3U);
}

TEST(MarkovFit, ASingleModelOfALinearSystemIsAsGoodAndTheVerdictSaysSo) {
  const MadeSwitched made = made_linear(1500, 3);
  const markov::Fitted fit = fit_of(made.recording, 0);
  EXPECT_EQ(fit.model.modes.size(), 1U);
  EXPECT_FALSE(fit.summary.usable.verdict);
  EXPECT_THAT(fit.summary.usable.reason, HasSubstr("use an ARX model"));
  EXPECT_FALSE(fit_of(made.recording, 2).summary.usable.verdict);
}

TEST(MarkovFit, ASingleModelLosesOnHeldOutDataOfThreeModes) {
  const MadeSwitched learned = made_chain(2000, 4), judged = made_chain(1000, 5);
  const auto likelihood = [&](int modes) {
    return markov::believe(fit_of(learned.recording, modes).model, judged.recording, kChannels)->log_likelihood.mean();
  };
  EXPECT_GT(likelihood(3), likelihood(1) + 0.5);
}

TEST(MarkovFit, RowsWithAMissingSampleAreLeftOutAndNothingCrossesThem) {
  MadeSwitched made = made_chain(2000, 6);
  for (std::size_t t = 50; t < 2000; t += 400) made.recording.channels[1].samples[t] = std::nan("");
  const markov::Fitted fit = fit_of(made.recording);
  EXPECT_EQ(fit.summary.samples_used, 1999U - 2 * 5);
  EXPECT_EQ(markov::make_rows({&made.recording, 1}, kChannels, first_order())->runs.size(), 6U);
  EXPECT_EQ(fit.model.modes.size(), 3U);
}

TEST(MarkovFit, ARecordingWithoutAUsableRowIsNotJudged) {
  const std::vector<Recording> both{made_linear(1, 9).recording, made_linear(300, 10).recording};
  const auto fit = markov::fit(both, kChannels, {.orders = first_order(), .modes = 1});
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_EQ(fit->summary.samples_used, 299U);
  EXPECT_GT(fit->summary.fit_percent[0], 70);
}

TEST(MarkovFit, TheSameSeedGivesTheSameModel) {
  const MadeSwitched made = made_chain(600, 7);
  const markov::Fitted one = fit_of(made.recording, 2), two = fit_of(made.recording, 2);
  EXPECT_EQ(one.model.transitions, two.model.transitions);
  EXPECT_EQ(one.model.modes[0].theta, two.model.modes[0].theta);
}

TEST(MarkovFit, RefusesWhatItCannotFitByName) {
  const MadeSwitched made = made_chain(60, 8);
  const auto error = [&](int modes, const ChannelChoice& channels = kChannels) {
    const auto fit = markov::fit({&made.recording, 1}, channels, {.orders = first_order(), .modes = modes});
    return fit ? std::string("no error") : fit.error().message;
  };
  EXPECT_THAT(error(65), HasSubstr("the number of modes is 65, expected 1 to 64"));
  EXPECT_THAT(error(20), HasSubstr("59 usable rows, expected at least"));
  EXPECT_THAT(error(2, {{"wind"}, {"y"}}), HasSubstr("has no channel 'wind'"));
  EXPECT_THAT(markov::fit({}, kChannels, {.orders = first_order()}).error().message, HasSubstr("no recording"));
}

// The seed is fixed; standard errors are a little small where rows are shared out among modes.
TEST(MarkovFit, ModesThatDifferInNoiseAloneAreReportedAsSuch) {
  const markov::Fitted noise = fit_of_turns({0.7, 0.5, 0.1}, {0.7, 0.5, 0.1}, 5);
  EXPECT_NEAR(std::abs(std::log(noise.model.modes[1].shock[0] / noise.model.modes[0].shock[0])), std::log(5), 0.15);
  EXPECT_TRUE(noise.summary.usable.verdict) << noise.summary.usable.reason;
  EXPECT_THAT(noise.summary.usable.reason, HasSubstr("by the size of its noise alone"));
  const markov::Fitted constant = fit_of_turns({0.7, 0.5, -0.5}, {0.7, 0.5, 0.5}, 1);
  EXPECT_THAT(constant.summary.usable.reason, HasSubstr("predicts held-out rows better"));
}

// A random walk with a drift fits best with a pole at or beyond 1.
TEST(MarkovFit, AnUnstableModeIsMadeStableAndStillMeetsItsMean) {
  const Recording recording =
      record_switched({{1.01, 0.001, 0}}, 400, 3, 0.1, [](int, double, double, double) { return 0; }).recording;
  const auto rows = markov::make_rows({&recording, 1}, kChannels, first_order());
  ASSERT_TRUE(rows) << rows.error().message;
  const Eigen::VectorXd all = Eigen::VectorXd::Ones(rows->rows()), none = Eigen::VectorXd::Zero(1);
  markov::Mode mode = markov::fit_mode(*rows, all, none);
  EXPECT_TRUE(markov::limit_radius(0.9, *rows, all, none, mode));
  const ArxMode stable = markov::model_mode(mode, *rows);
  EXPECT_NEAR(stable.theta[0][0], -0.9, 1e-7);  // a radius is that of coefficients in single precision
  EXPECT_NEAR((rows->y - rows->phi * mode.theta).mean(), 0, 1e-9);
  EXPECT_FALSE(markov::limit_radius(0.901, *rows, all, none, mode));
}

// Without noise, and with modes that are known from the past, a simulation is the recording.
TEST(MarkovPrediction, OfANoiselessRecordingOfOneModeIsTheRecording) {
  const auto made = record_switched({{0.7, 0.5, 0.2}}, 200, 9, 0.0, [](int, double, double, double) { return 0; });
  SwitchedArxModel model{first_order(), {0}, {0}, {{{{-0.7, 0.5}}, {}, {0.2}, {0.1}}}, {1}, {1}};
  for (int steps : {1, 5, kFreeRun}) {
    const auto predicted = markov::predict(model, made.recording, kChannels, steps);
    ASSERT_TRUE(predicted) << predicted.error().message;
    const std::size_t first = steps == kFreeRun ? 1 : static_cast<std::size_t>(steps);
    EXPECT_TRUE(std::isnan((*predicted)[0][first - 1]));
    for (std::size_t t = first; t < 200; ++t) {
      ASSERT_NEAR((*predicted)[0][t], made.recording.channels[1].samples[t], 1e-9) << steps << " " << t;
    }
  }
}

TEST(MarkovPrediction, NothingMeasuredAfterAMissingSampleIsUsed) {
  auto made = record_switched({{0.7, 0.5, 0.2}}, 50, 9, 0.0, [](int, double, double, double) { return 0; });
  made.recording.channels[1].samples[10] = std::nan("");
  const SwitchedArxModel model{first_order(), {0}, {0}, {{{{-0.7, 0.5}}, {}, {0.2}, {0.1}}}, {1}, {1}};
  const auto predicted = markov::predict(model, made.recording, kChannels, 3);
  ASSERT_TRUE(predicted) << predicted.error().message;
  // Row 13 lacks the sample that it is predicted from; rows 11 and 12 are predicted from earlier ones.
  for (const std::size_t row : {11, 12, 13, 14}) EXPECT_EQ(std::isnan((*predicted)[0][row]), row == 13) << row;
}

TEST(MarkovPrediction, OneStepAheadIsTheMeanOverModesByTheirProbabilities) {
  const auto made = made_chain(50, 10);
  SwitchedArxModel model{first_order(), {0}, {0}, {}, {0.25, 0.75}, {0.25, 0.75, 0.25, 0.75}};
  model.modes = {{{{-0.5, 1}}, {}, {0}, {0.1}}, {{{0.3, -1}}, {}, {1}, {0.1}}};
  const auto predicted = markov::predict(model, made.recording, kChannels, 1);
  ASSERT_TRUE(predicted);
  const auto &u = made.recording.channels[0].samples, &y = made.recording.channels[1].samples;
  for (std::size_t t = 1; t < 50; ++t) {
    const double expected = 0.25 * (0.5 * y[t - 1] + u[t - 1]) + 0.75 * (-0.3 * y[t - 1] - u[t - 1] + 1);
    ASSERT_NEAR((*predicted)[0][t], expected, 1e-12);
  }
  EXPECT_THAT(markov::predict(model, made.recording, kChannels, -1).error().message, HasSubstr("-1 steps ahead"));
}

}  // namespace
}  // namespace wisp::markov_fit_test
