#include "learn/arx/simulation/focus.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "learn/arx/fit/given_rows.hpp"
#include "learn/arx/judge/prediction.hpp"
#include "learn/arx/made_system.hpp"
#include "learn/arx/simulation/focus_choice.hpp"
#include "learn/arx/simulation/held_out.hpp"
#include "learn/arx/simulation/output_error.hpp"
#include "learn/arx/simulation/refine.hpp"

namespace wisp::focus_test {
namespace {

using testing::HasSubstr;

// One lightly damped output, without noise of its own.
ArxModel ringing() {
  ArxModel model;
  model.orders = {OrderMatrix(1, 1, 2), OrderMatrix(1, 1, 2), OrderMatrix(1, 1, 1)};
  model.theta = {{-1.7, 0.9, 1.0, 0.5}};
  model.constant = {0};
  model.output_mean = {5};
  model.input_mean = {1};
  model.noise.sd = {0};
  return model;
}

// The output is measured with white noise: an output error, which least squares does not expect.
Recording measured_with_noise(std::size_t rows, unsigned seed, double sd) {
  Recording recording = record_system(ringing(), rows, seed);
  std::mt19937_64 generator(seed + 1000);
  std::normal_distribution<double> noise(0, sd);
  for (double& y : recording.channels[1].samples) y += noise(generator);
  return recording;
}

const ChannelChoice kChannels{{"u1"}, {"y1"}};

arx::FocusedFit focused(std::span<const Recording> recordings, ArxFocus focus, const ArxOptions& options,
                        const ChannelChoice& channels = kChannels) {
  auto plain = fit_arx(recordings, channels, options);
  EXPECT_TRUE(plain) << plain.error().message;
  auto fit = arx::focus_fit(recordings, channels, options, std::move(*plain), {focus}, {});
  EXPECT_TRUE(fit) << fit.error().message;
  return std::move(*fit);
}

double free_run_fit(const ArxModel& model, const Recording& recording) {
  return prediction_figures(model, {&recording, 1}, kChannels, {.steps = {kFreeRun}})->front().fit_percent[0];
}

TEST(Focus, AnOutputMeasuredWithNoiseIsRefinedToTheTrueCoefficients) {
  const Recording recording = measured_with_noise(1500, 1, 1);
  const auto fit = focused({&recording, 1}, ArxFocus::kAuto, {.orders = ringing().orders});
  ASSERT_TRUE(fit.outcome.refined);
  for (std::size_t p = 0; p < 4; ++p) {
    EXPECT_NEAR(fit.fit.model.theta[0][p], ringing().theta[0][p], 5 * fit.fit.model.std_error[0][p]) << p;
  }
  const auto squares = fit_arx({&recording, 1}, kChannels, {.orders = ringing().orders});
  const Recording unseen = record_system(ringing(), 1000, 2);
  EXPECT_LT(free_run_fit(squares->model, unseen), 80);
  EXPECT_GT(free_run_fit(fit.fit.model, unseen), 95);
}

TEST(Focus, ResidualsNoiseAndCriteriaAreOfTheRefinedModel) {
  const Recording recording = measured_with_noise(1500, 1, 1);
  const auto fit = focused({&recording, 1}, ArxFocus::kSimulation, {.orders = ringing().orders});
  const auto one_step = prediction_figures(fit.fit.model, {&recording, 1}, kChannels, {.steps = {1}});
  EXPECT_NEAR(fit.fit.summary.loss[0] / one_step->front().mean_square[0], 1, 1e-9);
  EXPECT_NEAR(fit.fit.summary.fit_percent[0], one_step->front().fit_percent[0], 1e-6);
  EXPECT_NEAR(fit.fit.model.noise.sd[0] / std::sqrt(fit.fit.summary.loss[0]), 1, 0.01);
}

TEST(Focus, SamplesMayBeMissingAndRecordingsSeveral) {
  std::vector<Recording> recordings{measured_with_noise(700, 3, 1), measured_with_noise(500, 4, 1),
                                    measured_with_noise(400, 5, 1)};
  for (std::size_t t = 100; t < 140; ++t) {
    recordings[0].channels[1].samples[t] = std::numeric_limits<double>::quiet_NaN();
  }
  recordings[1].channels[0].samples[250] = std::numeric_limits<double>::quiet_NaN();
  const auto fit = focused(recordings, ArxFocus::kSimulation, {.orders = ringing().orders});
  ASSERT_TRUE(fit.outcome.refined);
  EXPECT_GT(free_run_fit(fit.fit.model, record_system(ringing(), 1000, 2)), 95);
}

TEST(Focus, PredictionStaysAtLeastSquares) {
  const Recording recording = measured_with_noise(800, 1, 1);
  const auto plain = fit_arx({&recording, 1}, kChannels, {.orders = ringing().orders});
  const auto fit = focused({&recording, 1}, ArxFocus::kPrediction, {.orders = ringing().orders});
  EXPECT_FALSE(fit.outcome.refined);
  EXPECT_EQ(fit.fit.model.theta, plain->model.theta);
  EXPECT_EQ(fit.fit.model.std_error, plain->model.std_error);
}

TEST(Focus, WhatLeastSquaresDescribesIsLeftToIt) {
  ArxModel model = ringing();
  model.noise.sd = {1};
  const Recording recording = record_system(model, 1500, 7);
  const auto plain = fit_arx({&recording, 1}, kChannels, {.orders = model.orders});
  const auto fit = focused({&recording, 1}, ArxFocus::kAuto, {.orders = model.orders});
  EXPECT_EQ(fit.fit.model.theta, plain->model.theta);
  EXPECT_THAT(fit.outcome.reason, HasSubstr("no better"));
}

TEST(Focus, AFewRowsAndNoInputsAreLeftToLeastSquaresWithTheReason) {
  const Recording brief = measured_with_noise(8, 1, 1);
  EXPECT_EQ(focused({&brief, 1}, ArxFocus::kAuto, {.orders = ringing().orders}).outcome.reason,
            "too few rows to hold some out");
  ArxOrders alone{OrderMatrix(1, 1, 2), OrderMatrix(1, 0), OrderMatrix(1, 0)};
  const Recording recording = measured_with_noise(500, 1, 1);
  EXPECT_EQ(focused({&recording, 1}, ArxFocus::kSimulation, {.orders = alone}, {{}, {"y1"}}).outcome.reason,
            "no input drives a free simulation");
}

TEST(Focus, StandardErrorsAreThoseOfRepeatedRecordings) {
  const ArxOptions options{.orders = ringing().orders};
  const int repeats = 40;
  for (std::size_t p = 0; p < 4; ++p) {
    double sum = 0, square = 0, said = 0;
    for (unsigned seed = 0; seed < repeats; ++seed) {
      const Recording recording = measured_with_noise(600, 100 + seed, 0.5);
      const auto fit = focused({&recording, 1}, ArxFocus::kSimulation, options);
      const double theta = fit.fit.model.theta[0][p];
      sum += theta / repeats;
      square += theta * theta / repeats;
      said += fit.fit.model.std_error[0][p] * fit.fit.model.std_error[0][p] / repeats;
    }
    EXPECT_GT((square - sum * sum) / said, 0.4) << p;
    EXPECT_LT((square - sum * sum) / said, 2.5) << p;
    EXPECT_NEAR(sum, ringing().theta[0][p], 2 * std::sqrt(said)) << p;
  }
}

// Least squares, one refined candidate and many lags: the squared error of every part of every fold.
arx::Unit judged(const std::vector<double>& refined, const std::vector<double>& many) {
  const auto folds = static_cast<Eigen::Index>(refined.size());
  arx::Unit unit{{0}};
  unit.candidates = {{}, {.one_step_weight = 1}, {.kernel_lags = 15}};
  unit.squares.resize(3, folds * arx::kParts);
  for (Eigen::Index f = 0; f < folds; ++f) {
    auto fold = unit.squares.middleCols(f * arx::kParts, arx::kParts);
    fold.row(0).setConstant(1);
    fold.row(1).setConstant(refined[std::size_t(f)]);
    fold.row(2).setConstant(many[std::size_t(f)]);
  }
  unit.estimated = unit.squares;
  return unit;
}

TEST(FocusChoice, ACandidateThatIsBetterInEveryFoldIsTaken) {
  arx::Unit unit = judged({0.5, 0.4, 0.6}, {2, 2, 2});
  unit.pick(false);
  EXPECT_EQ(unit.picked, 1U);
}

TEST(FocusChoice, ACandidateThatLosesOneFoldIsLeftHoweverMuchItGainsInTheOthers) {
  arx::Unit unit = judged({0.01, 0.01, 1.6}, {2, 2, 2});
  unit.pick(false);
  EXPECT_EQ(unit.picked, 0U);
}

TEST(FocusChoice, WhatIsRefinedMayLoseAFoldByFivePointsOfFit) {
  arx::Unit unit = judged({0.01, 0.01, 1.6}, {0.001, 0.001, 1.6});
  unit.sizes = {20, 20, 20};
  unit.pick(false);
  EXPECT_EQ(unit.picked, 1U);
  unit.sizes = {20, 20, 10};
  unit.pick(false);
  EXPECT_EQ(unit.picked, 0U);
}

TEST(FocusChoice, ManyLagsAreTakenOnlyWhereTheyAreBetterFromTheBestInitialStateToo) {
  arx::Unit unit = judged({0.8, 0.8, 0.8}, {0.3, 0.31, 0.32});
  unit.pick(false);
  EXPECT_EQ(unit.kernel_lags(), 15);
  for (double share : {1.0, 0.95}) {  // of a mean square: less than 5 % of its root
    unit.estimated.row(2) = share * unit.estimated.row(1);
    unit.pick(false);
    EXPECT_TRUE(unit.refined()) << share;
  }
}

TEST(FocusChoice, ManyLagsNeedNotBeatWhatCannotStartFromMeasuredSamples) {
  arx::Unit unit = judged({2, 2, 2}, {0.3, 0.31, 0.32});
  unit.estimated.row(1).setConstant(0.1);
  unit.pick(false);
  EXPECT_EQ(unit.kernel_lags(), 15);
}

TEST(FocusChoice, WhatIsNearestToLeastSquaresIsTakenOfWhatIsAsGood) {
  arx::Unit unit = judged({1.05, 1.05, 1.05}, {1, 0.98, 0.99});
  unit.pick(false);
  EXPECT_EQ(unit.picked, 0U);
}

// Two outputs: least squares together, states, and least squares of each on its own; the same error in all parts.
arx::Block two_outputs(double squares, double states, double own, double second_output_of_states) {
  const auto filled = [](arx::Unit& unit, std::initializer_list<double> errors) {
    for (auto* matrix : {&unit.squares, &unit.estimated}) matrix->resize(Eigen::Index(errors.size()), 6 * arx::kParts);
    unit.by_output.resize(Eigen::Index(errors.size()), Eigen::Index(unit.outputs.size()));
    Eigen::Index w = 0;
    for (double error : errors) {
      unit.candidates.push_back({});
      for (auto* matrix : {&unit.squares, &unit.estimated}) matrix->row(w).setConstant(error);
      unit.by_output.row(w++).setConstant(6 * error);
    }
  };
  arx::Block block{{{0, 1}}};
  filled(block.together, {squares, states});
  block.together.candidates[1].states = 4;
  block.together.by_output(1, 1) = 6 * second_output_of_states;
  for (int output : {0, 1}) filled(block.apart.emplace_back(arx::Unit{{output}, true}), {own});
  return block;
}

TEST(FocusChoice, StatesAreTakenWhereTheyAreBetterThanAllElseForEveryOutput) {
  arx::Block block = two_outputs(1, 0.2, 0.5, 0.3);
  block.pick(false);
  EXPECT_FALSE(block.decoupled);
  EXPECT_EQ(block.together.states(), 4);
}

TEST(FocusChoice, StatesAreLeftWhereOutputsOnTheirOwnAreBetterOrOneOutputLoses) {
  arx::Block better = two_outputs(1, 0.6, 0.5, 0.6);
  better.pick(false);
  EXPECT_TRUE(better.decoupled);
  arx::Block loses = two_outputs(1, 0.2, 0.5, 0.51);
  loses.pick(false);
  EXPECT_TRUE(loses.decoupled);
}

TEST(HeldOut, NoFoldLearnsFromWhatItHoldsOutAndHalfLearnOnlyFromWhatIsEarlier) {
  Recording recording = measured_with_noise(100, 1, 1);
  auto& samples = recording.channels[0].samples;
  for (std::size_t t = 0; t < samples.size(); ++t) samples[t] = static_cast<double>(t);
  int forward = 0;
  const auto folds = arx::folds_of({&recording, 1});
  for (const arx::Fold& fold : folds) {
    const auto& held_out = fold.held_out[0].channels[0].samples;
    bool earlier = true;
    for (const Recording& learned : fold.learned) {
      for (double t : learned.channels[0].samples) {
        EXPECT_TRUE(t < held_out.front() || t > held_out.back());
        earlier &= t < held_out.front();
      }
    }
    forward += earlier ? 1 : 0;
  }
  EXPECT_EQ(folds.size(), 6U);
  EXPECT_EQ(forward, 4);  // the last 30 % follow all else too
}

// A delay that orders of 2 do not reach, in noise: short orders cannot describe it.
Recording late_answer(std::size_t rows, std::size_t delay, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Recording recording = record_system(ringing(), rows, 11);
  auto& u = recording.channels[0].samples;
  auto& y = recording.channels[1].samples;
  for (double& value : u) value = normal(generator);
  const auto input = [&](std::size_t t, std::size_t lag) { return t >= lag ? u[t - lag] : 0.0; };
  for (std::size_t t = 0; t < rows; ++t) {
    y[t] = (t > 0 ? 0.5 * y[t - 1] : 0) + input(t, delay) + 0.5 * input(t, delay + 3) + 0.1 * normal(generator);
  }
  return recording;
}

TEST(Focus, ManyLagsUnderAKernelAreChosenWhereTheOrdersMissTheResponse) {
  const ArxOptions options{.orders = ringing().orders};
  for (const auto& [delay, lags] : {std::pair{8, 15}, std::pair{20, 30}}) {
    const Recording seen = late_answer(1200, std::size_t(delay), 3), unseen = late_answer(600, std::size_t(delay), 4);
    const auto fit = focused({&seen, 1}, ArxFocus::kAuto, options);
    ASSERT_TRUE(fit.outcome.refined);
    EXPECT_EQ(fit.fit.model.orders.nb(0, 0), lags);
    EXPECT_GT(free_run_fit(fit.fit.model, unseen), 85);
    const auto kept = focused({&seen, 1}, ArxFocus::kSimulation, options);
    EXPECT_TRUE(kept.fit.model.orders == options.orders);
  }
}

// A slow output that begins at rest is below the level of its inputs for long: its mean is no operating point.
Recording slow_from_rest(std::size_t rows) {
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  Recording recording = record_system(ringing(), rows, 11);
  auto& u = recording.channels[0].samples;
  auto& y = recording.channels[1].samples;
  double level = 0;
  for (std::size_t t = 0; t < rows; ++t) {
    u[t] = t % 40 == 0 ? 5 + normal(generator) : u[t - 1];
    y[t] = level + 0.5 * normal(generator);
    level += 0.01 * (10 * u[t] - level);
  }
  return recording;
}

TEST(Focus, FreeRunsTellTheLevelOfASlowOutput) {
  const Recording seen = slow_from_rest(800);
  const ArxOptions options{.orders = {OrderMatrix(1, 1, 1), OrderMatrix(1, 1, 1), OrderMatrix(1, 1, 1)}};
  const auto fit = focused({&seen, 1}, ArxFocus::kSimulation, options);
  const ArxModel& model = fit.fit.model;
  const double level = model.output_mean[0] + model.constant[0] / (1 + model.theta[0][0]);
  EXPECT_NEAR(level, 10 * model.input_mean[0], 0.5);
  EXPECT_LT(model.output_mean[0], 10 * model.input_mean[0] - 4);
}

TEST(OutputError, TheGradientIsThatOfDifferences) {
  Recording recording = record_system(made_system(), 300, 3, 5);
  recording.channels[2].samples[120] = std::numeric_limits<double>::quiet_NaN();
  const ChannelChoice channels{{"u1", "u2"}, {"y1", "y2"}};
  const auto signals = gather_signals({&recording, 1}, channels, ArxOffset::kMean);
  ASSERT_TRUE(signals);
  const ArxModel model = made_system();
  const arx::SimulationBlock block(*signals, model.orders, {0, 1}, false, model.orders.history());
  Eigen::VectorXd theta(static_cast<Eigen::Index>(block.terms().size()));
  theta << row_of_model(model, 0, *signals, ArxOffset::kMean).theta,
      row_of_model(model, 1, *signals, ArxOffset::kMean).theta;
  theta *= 0.97;
  const arx::GaussNewton exact = arx::gauss_newton(block, arx::simulate_block(block, theta));
  for (Eigen::Index p = 0; p < theta.size(); ++p) {
    constexpr double kStep = 1e-5;
    Eigen::VectorXd up = theta, down = theta;
    up[p] += kStep;
    down[p] -= kStep;
    const double slope = (arx::simulate_block(block, up).cost - arx::simulate_block(block, down).cost) / (2 * kStep);
    EXPECT_NEAR(-2 * exact.gradient[p], slope, 1e-5 * (1 + std::abs(slope))) << p;
  }
}

TEST(Refine, AStartWithACancellingPoleSimulatesAsTheLowerOrder) {
  const Recording recording = measured_with_noise(500, 9, 3);
  const auto signals = gather_signals({&recording, 1}, kChannels, ArxOffset::kMean);
  ArxOrders lower = ringing().orders, higher = lower;
  higher.na(0, 0) = higher.nb(0, 0) = 3;
  const arx::OneStepOptions options{.orders = higher, .offset = ArxOffset::kEstimate, .first_sample = 3};
  const arx::SimulationBlock block(*signals, higher, {0}, true, 3), below(*signals, lower, {0}, true, 3);
  const auto loss = arx::one_step_loss(*signals, below, {lower, ArxOffset::kEstimate, 3});
  const double cost = arx::refine(below, loss, loss.best, {}).simulation.cost;
  const auto starts = arx::cancelling_starts(*signals, block, options, {});
  ASSERT_EQ(starts.size(), 2U);
  for (const Eigen::VectorXd& start : starts) {
    const double own = arx::simulate_block(block, start).cost;
    EXPECT_LE(own, cost * (1 + 1e-6));  // its initial state has one number more
    EXPECT_GE(own, cost * 0.95);
  }
}

// A fast and a slow mode, of which the slow one is small: where it is missed the free run drifts away.
Recording fast_and_slow(std::size_t rows, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Recording recording = record_system(ringing(), rows, 11);
  auto& u = recording.channels[0].samples;
  auto& y = recording.channels[1].samples;
  double fast = 0, slow = 0, level = 5;
  for (std::size_t t = 0; t < rows; ++t) {
    if (t % 100 == 0) level = 5 + 2 * normal(generator);
    u[t] = level;
    y[t] = fast + slow + 0.05 * normal(generator);
    fast = 0.9 * fast + 0.1 * u[t];
    slow = 0.995 * slow + 0.005 * u[t];
  }
  return recording;
}

TEST(Focus, ASlowModeBesideAFastOneIsFound) {
  const Recording seen = fast_and_slow(700, 3), unseen = fast_and_slow(500, 4);
  const ArxOptions options{.orders = {OrderMatrix(1, 1, 3), OrderMatrix(1, 1, 3), OrderMatrix(1, 1, 1)}};
  const auto fit = focused({&seen, 1}, ArxFocus::kSimulation, options);
  EXPECT_GT(free_run_fit(fit.fit.model, unseen), 90);
}

TEST(Refine, WithGivenFeedbackTheDriveHasTheLeastErrorAtOnce) {
  Recording recording = record_system(made_system(), 400, 3, 5);
  const ChannelChoice channels{{"u1", "u2"}, {"y1", "y2"}};
  const auto signals = gather_signals({&recording, 1}, channels, ArxOffset::kMean);
  const ArxOrders orders = made_system().orders;
  const int first = orders.history();
  const arx::SimulationBlock block(*signals, orders, {0, 1}, false, first);
  const auto loss = arx::one_step_loss(*signals, block, {.orders = orders, .first_sample = first});
  const auto path = arx::drive_path(block, loss, loss.best, std::array{1e9, 0.0});
  ASSERT_EQ(path.size(), 2U);
  EXPECT_LT((path[0].simulation.theta - loss.best).norm(), 1e-6 * loss.best.norm());
  const arx::GaussNewton slope = arx::gauss_newton(block, path[1].simulation);
  for (Eigen::Index p = 0; p < loss.best.size(); ++p) {
    if (block.terms()[std::size_t(p)].channel < block.size()) {
      EXPECT_EQ(path[1].simulation.theta[p], loss.best[p]) << p;
    } else {
      EXPECT_NEAR(slope.gradient[p] / std::sqrt(slope.curvature(p, p)), 0, 1e-6) << p;
    }
  }
  EXPECT_LT(path[1].simulation.cost, path[0].simulation.cost);
}

TEST(Refine, EveryStepIsStableAndLessensTheCriterion) {
  const Recording recording = measured_with_noise(500, 9, 3);
  const auto signals = gather_signals({&recording, 1}, kChannels, ArxOffset::kMean);
  const ArxOrders orders = ringing().orders;
  const arx::SimulationBlock block(*signals, orders, {0}, false, orders.history());
  const auto loss = arx::one_step_loss(*signals, block, {.orders = orders, .first_sample = orders.history()});
  Eigen::VectorXd unstable(4);
  unstable << 2.1, -1.2, 0.1, 0.1;
  double before = std::numeric_limits<double>::infinity();
  for (int steps = 0; steps < 8; ++steps) {
    const auto at = arx::refine(block, loss, unstable, {.steps = steps});
    EXPECT_LT(block.radius(at.simulation.theta), 1);
    EXPECT_LE(at.value, before);
    before = at.value;
  }
}

}  // namespace
}  // namespace wisp::focus_test
