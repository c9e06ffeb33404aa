#include "learn/judge/arx_verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "learn/arx/learn_arx.hpp"

namespace wisp::arx_verdict_test {
namespace {

using testing::HasSubstr;

// A recording of white inputs and what `next` makes of the input and the output before.
template <class Next>
Recording made(std::size_t rows, unsigned seed, Next next) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Recording recording;
  recording.rate_hz = 1;
  recording.channels = {{"u", "", Role::kInput, {}}, {"y", "", Role::kOutput, {}}};
  double before = 0, y = 0;
  for (std::size_t t = 0; t < rows; ++t) {
    const double u = normal(generator);
    y = next(y, u, before, normal(generator));
    recording.channels[0].samples.push_back(u);
    recording.channels[1].samples.push_back(y);
    before = u;
  }
  return recording;
}

ReportVerdict verdict(const Recording& recording, const ArxRecipe& recipe) {
  const auto fit = learn_arx({&recording, 1}, recipe);
  EXPECT_TRUE(fit) << fit.error().message;
  return fit ? *fit->report.verdict : ReportVerdict{};
}

ArxRecipe driven(int order) { return {.inputs = {"u"}, .outputs = {"y"}, .na = order, .nb = order}; }

TEST(ArxVerdict, ASystemThatIsDrivenIsUsableAndSaysHowWellItSimulates) {
  const auto said =
      verdict(made(1000, 1, [](double y, double, double u, double e) { return 0.8 * y + u + 0.1 * e; }), driven(1));
  EXPECT_TRUE(said.usable);
  EXPECT_THAT(said.reason, HasSubstr("free simulation of held-out rows fits 9"));
}

TEST(ArxVerdict, WhiteNoiseIsNotUsable) {
  const Recording noise = made(1000, 2, [](double, double, double, double e) { return e; });
  const auto with_input = verdict(noise, driven(2));
  EXPECT_FALSE(with_input.usable);
  EXPECT_THAT(with_input.reason, HasSubstr("at least 40 % is needed"));
  const auto alone = verdict(noise, {.outputs = {"y"}, .na = 2, .nb = 0});
  EXPECT_FALSE(alone.usable);
  EXPECT_THAT(alone.reason, HasSubstr("no better than by its mean"));
}

TEST(ArxVerdict, ARandomWalkIsPredictedNoBetterThanByItsLastSample) {
  const Recording walk = made(1000, 3, [](double y, double, double, double e) { return y + e; });
  const auto said = verdict(walk, {.outputs = {"y"}, .na = 2, .nb = 0});
  EXPECT_FALSE(said.usable);
  EXPECT_THAT(said.reason, HasSubstr("last sample"));
}

TEST(ArxVerdict, AnOscillationWithoutInputsIsUsable) {
  double older = 0;
  const Recording wave = made(1000, 4, [&](double y, double, double, double e) {
    const double next = 1.8 * y - 0.95 * older + 0.1 * e;
    older = y;
    return next;
  });
  EXPECT_TRUE(verdict(wave, {.outputs = {"y"}, .na = 2, .nb = 0}).usable);
}

// The output wanders by itself, and the input follows it.
TEST(ArxVerdict, AnInputThatTheOutputSetsTellsNothing) {
  double level = 0;
  const Recording follower = made(1000, 6, [&](double, double, double, double e) { return level = 0.995 * level + e; });
  Recording reversed = follower;
  auto& u = reversed.channels[*find_channel(reversed, "u")].samples;
  const auto& y = reversed.channels[*find_channel(reversed, "y")].samples;
  u[0] = 0;
  for (std::size_t t = 1; t < u.size(); ++t) u[t] = 0.5 * u[t - 1] + 0.5 * y[t - 1];
  const auto said = verdict(reversed, driven(2));
  EXPECT_FALSE(said.usable);
  EXPECT_THAT(said.reason, HasSubstr("is set by 'y'"));
}

// The recording is without noise: what its residuals show is a trace of its means.
TEST(ArxVerdict, ATraceInResidualsIsNoEffect) {
  const Recording clean = made(600, 7, [](double y, double, double before, double) { return 0.9 * y + 0.5 * before; });
  EXPECT_TRUE(verdict(clean, driven(1)).usable) << verdict(clean, driven(1)).reason;
}

TEST(ArxVerdict, TenRowsAreTooFew) {
  const Recording brief = made(10, 5, [](double y, double, double u, double e) { return 0.5 * y + u + 0.01 * e; });
  const auto said = verdict(brief, driven(1));
  EXPECT_FALSE(said.usable);
  EXPECT_THAT(said.reason, HasSubstr("9 rows are too few for 2 coefficients"));
}

TEST(ArxVerdict, AnInputThatActsAtOnceIsToldOf) {
  const Recording direct =
      made(1000, 6, [](double y, double u, double before, double e) { return 0.5 * y + u + 2 * before + 0.1 * e; });
  const auto said = verdict(direct, driven(2));
  EXPECT_FALSE(said.usable);
  EXPECT_THAT(said.reason, HasSubstr("acts on 'y' in the same sample"));
  EXPECT_THAT(said.reason, HasSubstr("try --nk 0"));
  ArxRecipe at_once = driven(2);
  at_once.nk = 0;
  EXPECT_TRUE(verdict(direct, at_once).usable);
}

// A recording of an input and what a first-order plant makes of it and of noise; gain 0: the output moves by itself.
template <class Input, class Own>
Recording driven_by(unsigned seed, double gain, Input input, Own own) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Recording recording = made(1000, seed, [](double, double, double, double) { return 0.0; });
  auto &u = recording.channels[0].samples, &y = recording.channels[1].samples;
  double state = 0;
  for (std::size_t t = 0; t < u.size(); ++t) {
    state = 0.8 * state + gain * (t > 0 ? u[t - 1] : 0) + 0.02 * gain * normal(generator);
    u[t] = input(double(t)) + 0.1 * normal(generator);
    y[t] = state + own(double(t)) + (gain == 0 ? 0.1 * normal(generator) : 0);
  }
  return recording;
}

double nothing(double) { return 0; }
double ramp(double t) { return 3 * t / 1000; }
double wave(double t) { return std::sin(2 * std::numbers::pi * t / 47); }

TEST(ArxVerdict, UnrelatedChannelsThatShareADriftOrAPeriodAreNotUsable) {
  int refused = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    for (const auto shape : {ramp, wave}) {
      const auto later = [&](double t) { return shape(t + 9); };
      const auto said = verdict(driven_by(seed, 0, shape, later), driven(4));
      refused += !said.usable;
      EXPECT_THAT(said.reason, HasSubstr(said.usable ? "" : "a drift or a period, which unrelated channels may share"))
          << seed;
    }
  }
  EXPECT_EQ(refused, 12);
}

TEST(ArxVerdict, APlantIsUsableWhoseInputDriftsOrRepeatsAndAlsoMovesByItself) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    EXPECT_TRUE(verdict(driven_by(seed, 1, ramp, nothing), driven(2)).usable) << seed;
    EXPECT_TRUE(verdict(driven_by(seed, 1, wave, nothing), driven(2)).usable) << seed;
  }
}

// The input copies the output with noise, which leaves the share that the output explains below the limit for inputs
// that are set. A controller with a movement of its own is as much set by the output, and drives it.
TEST(ArxVerdict, AnInputThatFollowsTheOutputWithNoiseIsNotUsableAndAControllerIs) {
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  Recording follower = made(1500, 6, [](double y, double, double, double e) { return 0.98 * y + e; }), loop = follower;
  auto &u = follower.channels[0].samples, &y = follower.channels[1].samples;
  for (std::size_t t = 1; t < u.size(); ++t) u[t] = 0.5 * u[t - 1] + 0.5 * y[t];
  for (double& one : u) one += 0.3 * normal(generator);
  const auto said = verdict(follower, driven(4));
  EXPECT_FALSE(said.usable);
  EXPECT_THAT(said.reason, HasSubstr("no better than they do as they were"));
  auto &v = loop.channels[0].samples, &z = loop.channels[1].samples;
  for (std::size_t t = 1; t < v.size(); ++t) {
    v[t] = -0.8 * z[t - 1] + normal(generator);
    z[t] = 0.8 * z[t - 1] + 0.5 * v[t - 1] + 0.1 * normal(generator);
  }
  EXPECT_TRUE(verdict(loop, driven(4)).usable) << verdict(loop, driven(4)).reason;
}

TEST(ArxVerdict, AnInputThatIsAnotherSomeSamplesLaterIsNotUsable) {
  std::mt19937_64 generator(4);
  std::normal_distribution<double> normal;
  const Recording one =
      made(800, 9, [](double y, double, double before, double e) { return 0.7 * y + 4 * before + e; });
  for (const std::size_t later : {1u, 2u, 3u, 4u}) {
    Recording both = one;
    both.channels.push_back({"late", "", Role::kInput, one.channels[0].samples});
    auto& late = both.channels.back().samples;
    for (std::size_t t = late.size(); t-- > later;) late[t] = late[t - later] + 1e-6 * normal(generator);
    for (const bool swapped : {false, true}) {
      ArxRecipe recipe{.inputs = {swapped ? "late" : "u", swapped ? "u" : "late"}, .outputs = {"y"}, .na = 2, .nb = 4};
      const auto said = verdict(both, recipe);
      EXPECT_EQ(said.reason.find("tells nothing new") != std::string::npos, later < 4) << said.reason;
    }
  }
}

TEST(ArxVerdict, ADoubleIntegratorIsUsable) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    double speed = 0;
    const Recording cart =
        made(1000, seed, [&](double y, double, double before, double e) { return y + (speed += before + 0.01 * e); });
    EXPECT_TRUE(verdict(cart, driven(2)).usable) << seed << ": " << verdict(cart, driven(2)).reason;
  }
}

TEST(ArxVerdict, ARepairThatMovesCoefficientsFarIsNotUsable) {
  ArxSummary summary;
  summary.usable = {true, "fine"};
  summary.rows = 1000;
  summary.stable = {.radius = 0.999, .changed = true, .estimated = 2, .loss_factor = 40, .moved = 31};
  const ChannelChoice channels{{}, {"y"}};
  const ArxOrders orders{OrderMatrix(1, 1, 2), OrderMatrix(1, 0), OrderMatrix(1, 0)};
  arx::judge_use({channels, orders}, summary);
  EXPECT_FALSE(summary.usable.verdict);
  EXPECT_THAT(summary.usable.reason, HasSubstr("moved by 31 standard errors"));
}

TEST(ArxVerdict, ASimulationThatRunsAwayIsToldInAWord) {
  ArxSummary summary;
  summary.usable = {true, "fine"};
  summary.rows = 1000;
  summary.fit_percent = {99};
  summary.free_run_fit_percent = {-1e30};
  const ChannelChoice channels{{"u"}, {"y"}};
  const ArxOrders orders{OrderMatrix(1, 1, 2), OrderMatrix(1, 1, 1), OrderMatrix(1, 1, 1)};
  arx::judge_use({channels, orders}, summary);
  EXPECT_FALSE(summary.usable.verdict);
  EXPECT_THAT(summary.usable.reason, HasSubstr("it diverges"));
}

}  // namespace
}  // namespace wisp::arx_verdict_test
