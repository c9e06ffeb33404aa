#include "learn/arx/simulation/subspace.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <random>
#include <string>

#include "learn/arx/fit/arx_fit.hpp"
#include "learn/arx/judge/prediction.hpp"
#include "learn/arx/simulation/focus.hpp"
#include "learn/arx/simulation/held_out.hpp"

namespace wisp::subspace_test {
namespace {

using arx::StateSpace;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A structure: few lightly damped modes, which every output sees in its own mixture and two inputs drive.
StateSpace structure(int outputs, int modes, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  const auto any = [&](Index rows, Index columns) {
    return MatrixXd(MatrixXd::NullaryExpr(rows, columns, [&] { return normal(generator); }));
  };
  StateSpace out{MatrixXd::Zero(2 * modes, 2 * modes),
                 any(2 * modes, 2),
                 any(outputs, 2 * modes),
                 any(outputs, 2),
                 VectorXd::Zero(outputs),
                 VectorXd::Ones(outputs)};
  for (Index k = 0; k < modes; ++k) {
    const std::complex<double> pole = std::polar(0.97 - 0.01 * double(k), 0.3 + 0.5 * double(k));
    out.a.block(2 * k, 2 * k, 2, 2) << pole.real(), pole.imag(), -pole.imag(), pole.real();
  }
  return out;
}

ChannelChoice channels_of(const StateSpace& system) {
  ChannelChoice channels{{"u1", "u2"}, {}};
  for (int o = 0; o < system.outputs(); ++o) channels.outputs.push_back("y" + std::to_string(o + 1));
  return channels;
}

// From a random state on; every output is measured with noise of `share` of its size.
Recording record(const StateSpace& system, std::size_t rows, unsigned seed, double share) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Recording recording;
  recording.rate_hz = 50;
  const ChannelChoice channels = channels_of(system);
  for (const std::string& name : channels.inputs) {
    recording.channels.push_back({name, "", Role::kInput, std::vector<double>(rows)});
  }
  for (const std::string& name : channels.outputs) {
    recording.channels.push_back({name, "", Role::kOutput, std::vector<double>(rows)});
  }
  VectorXd x = VectorXd::NullaryExpr(system.states(), [&] { return 3 * normal(generator); });
  for (std::size_t t = 0; t < rows; ++t) {
    const VectorXd u = VectorXd::NullaryExpr(2, [&] { return normal(generator); });
    const VectorXd y = system.c * x + system.d * u + system.level;
    for (Index k = 0; k < 2; ++k) recording.channels[std::size_t(k)].samples[t] = u[k];
    for (Index o = 0; o < y.size(); ++o) recording.channels[std::size_t(2 + o)].samples[t] = y[o];
    x = system.a * x + system.b * u;
  }
  for (std::size_t c = 2; c < recording.channels.size() && share > 0; ++c) {
    auto& samples = recording.channels[c].samples;
    double square = 0;
    for (double y : samples) square += y * y / double(rows);
    for (double& y : samples) y += share * std::sqrt(square) * normal(generator);
  }
  return recording;
}

Signals signals_of(std::span<const Recording> recordings, const StateSpace& system) {
  return *gather_signals(recordings, channels_of(system), ArxOffset::kNone);
}

std::vector<int> all_outputs(const StateSpace& system) {
  std::vector<int> outputs;
  for (int o = 0; o < system.outputs(); ++o) outputs.push_back(o);
  return outputs;
}

// Response k rows after an impulse, in the data's units.
MatrixXd response(const StateSpace& model, const Signals& signals, int k) {
  MatrixXd out = model.d;
  if (k > 0) {
    MatrixXd reached = model.b;
    for (int i = 1; i < k; ++i) reached = model.a * reached;
    out = model.c * reached;
  }
  for (Index o = 0; o < out.rows(); ++o) {
    for (Index u = 0; u < out.cols(); ++u) {
      out(o, u) *= signals.scale[std::size_t(signals.outputs + u)] / signals.scale[std::size_t(o)];
    }
  }
  return out;
}

void expect_same_responses(const StateSpace& model, const Signals& signals, const StateSpace& truth, double tolerance) {
  Signals plain = signals;
  plain.scale.assign(plain.scale.size(), 1.0);
  for (int k = 0; k < 60; ++k) {
    const MatrixXd expected = response(truth, plain, k), found = response(model, signals, k);
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), tolerance * truth.b.cwiseAbs().maxCoeff()) << k;
  }
}

TEST(Subspace, FindsASystemThatIsMeasuredExactly) {
  const StateSpace truth = structure(5, 3, 1);
  const Recording recording = record(truth, 800, 2, 0);
  const Signals signals = signals_of({&recording, 1}, truth);
  const arx::Subspace subspace(signals, all_outputs(truth), false);
  const auto model = subspace.model(6, 0.999);
  ASSERT_TRUE(model);
  expect_same_responses(*model, signals, truth, 1e-5);
}

TEST(Subspace, NothingCrossesAGapOrFromOneRecordingToTheNext) {
  const StateSpace truth = structure(4, 2, 3);
  std::vector<Recording> recordings{record(truth, 400, 4, 0), record(truth, 300, 5, 0), record(truth, 250, 6, 0)};
  recordings[0].channels[1].samples[150] = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t t = 90; t < 97; ++t) recordings[1].channels[4].samples[t] = std::numeric_limits<double>::quiet_NaN();
  const Signals signals = signals_of(recordings, truth);
  const auto model = arx::Subspace(signals, all_outputs(truth), false).model(4, 0.999);
  ASSERT_TRUE(model);
  expect_same_responses(*model, signals, truth, 1e-5);
}

// The sum of squares that free simulation leaves, each output in shares of its energy.
double free_run_cost(const StateSpace& model, const arx::SimulationBlock& block) {
  double cost = 0;
  for (const arx::BlockRun& run : block.runs()) {
    const VectorXd start = arx::best_state(model, run, block.history(), block.weight());
    const MatrixXd rest = run.outputs.bottomRows(run.rows) - arx::simulate(model, run, block.history(), start);
    cost += (rest * block.weight().cwiseSqrt().asDiagonal()).squaredNorm();
  }
  return cost;
}

TEST(Subspace, WhatInputsDoIsBestForFreeSimulation) {
  const StateSpace truth = structure(4, 2, 7);
  const std::vector<Recording> recordings{record(truth, 500, 8, 0.2), record(truth, 300, 9, 0.2)};
  const Signals signals = signals_of(recordings, truth);
  const auto model = arx::Subspace(signals, all_outputs(truth), true).model(4, 0.999);
  ASSERT_TRUE(model);
  ArxOrders orders{OrderMatrix(4, 4, 1), OrderMatrix(4, 2, 1), OrderMatrix(4, 2, 0)};
  const arx::SimulationBlock block(signals, orders, all_outputs(truth), true, 1);
  const double least = free_run_cost(*model, block);
  std::mt19937_64 generator(10);
  std::normal_distribution<double> normal(0, 0.02);
  const auto nudge = [&](auto& matrix) {
    matrix = matrix.unaryExpr([&](double value) { return value + normal(generator); }).eval();
  };
  for (int attempt = 0; attempt < 10; ++attempt) {
    StateSpace other = *model;
    nudge(other.b), nudge(other.d), nudge(other.level);
    EXPECT_GT(free_run_cost(other, block), least);
  }
}

TEST(Subspace, TooFewRowsAndAChannelThatNeverMovesHaveNoModel) {
  const StateSpace truth = structure(5, 3, 1);
  Recording recording = record(truth, 40, 2, 0);
  EXPECT_EQ(arx::Subspace(signals_of({&recording, 1}, truth), all_outputs(truth), false).max_states(), 0);
  recording = record(truth, 800, 2, 0);
  std::fill(recording.channels[0].samples.begin(), recording.channels[0].samples.end(), 0.0);
  EXPECT_EQ(arx::Subspace(signals_of({&recording, 1}, truth), all_outputs(truth), false).max_states(), 0);
}

TEST(StateSpace, TheArxFormSimulatesAsTheStateDoesAndAddsNoUnstablePole) {
  StateSpace system = structure(3, 3, 11);
  system.level << 1, -2, 3;
  const Recording recording = record(system, 200, 12, 0);
  const auto column = [&](Index c, std::size_t t) { return recording.channels[std::size_t(c)].samples[t]; };
  for (int lags : {2, 5, 15}) {
    const arx::ArxForm form = arx::arx_form(system, lags);
    EXPECT_NEAR(arx::radius(form), 0.97, 1e-3) << lags;
    for (std::size_t t = std::size_t(lags); t < 200; ++t) {
      VectorXd y = form.constant;
      for (int l = 1; l <= lags; ++l) {
        for (Index o = 0; o < 3; ++o) y += form.feedback.col(3 * (l - 1) + o) * column(2 + o, t - std::size_t(l));
      }
      for (int l = 0; l <= lags; ++l) {
        for (Index k = 0; k < 2; ++k) y += form.drive.col(2 * l + k) * column(k, t - std::size_t(l));
      }
      for (Index o = 0; o < 3; ++o) EXPECT_NEAR(y[o], column(2 + o, t), 1e-4) << lags << " lags, row " << t;
    }
  }
}

TEST(StateSpace, HeldOutErrorsAreThoseOfItsArxForm) {
  const StateSpace system = structure(2, 2, 13);
  const Recording recording = record(system, 300, 14, 0.1);
  const Signals signals = signals_of({&recording, 1}, system);
  const auto model = arx::Subspace(signals, {0, 1}, false).model(4, 0.999);
  ASSERT_TRUE(model);
  const int lags = 6;
  ArxOrders orders{OrderMatrix(2, 2, lags), OrderMatrix(2, 2, lags + 1), OrderMatrix(2, 2, 0)};
  const arx::SimulationBlock block(signals, orders, {0, 1}, false, lags);
  const arx::ArxForm form = arx::arx_form(*model, lags);
  VectorXd theta(Index(block.terms().size()));
  for (std::size_t p = 0; p < block.terms().size(); ++p) {
    const arx::BlockTerm& term = block.terms()[p];
    theta[Index(p)] = term.channel < 2 ? form.feedback(term.row, 2 * (term.lag - 1) + term.channel)
                                       : form.drive(term.row, 2 * term.lag + term.channel - 2);
  }
  const arx::HeldOutErrors of_state = arx::held_out_errors(block, *model, form);
  const arx::HeldOutErrors of_form = arx::held_out_errors(block, theta);
  EXPECT_LT((of_state.measured - of_form.measured).cwiseAbs().maxCoeff(), 1e-4 * of_form.measured.maxCoeff());
  EXPECT_LE(of_form.estimated.sum(), of_state.estimated.sum() * 1.0001);  // its past outputs are freer than a state
}

arx::FocusedFit focused(const Recording& recording, const ChannelChoice& channels, ArxFocus focus, int order) {
  const int outputs = static_cast<int>(channels.outputs.size());
  const ArxOptions options{
      .orders = {OrderMatrix(outputs, outputs, order), OrderMatrix(outputs, 2, order), OrderMatrix(outputs, 2, 1)}};
  auto plain = fit_arx({&recording, 1}, channels, options);
  EXPECT_TRUE(plain) << plain.error().message;
  auto fit = arx::focus_fit({&recording, 1}, channels, options, std::move(*plain), {focus}, {});
  EXPECT_TRUE(fit) << fit.error().message;
  return std::move(*fit);
}

std::vector<double> free_run_fits(const ArxModel& model, const Recording& recording, const ChannelChoice& channels) {
  return prediction_figures(model, {&recording, 1}, channels, {.steps = {kFreeRun}})->front().fit_percent;
}

TEST(FocusOnStates, ManyOutputsThatShareFewModesAreSimulatedFromASubspaceEstimate) {
  const StateSpace truth = structure(10, 3, 21);
  const ChannelChoice channels = channels_of(truth);
  const Recording seen = record(truth, 900, 22, 0.1), unseen = record(truth, 500, 23, 0);
  const auto squares = focused(seen, channels, ArxFocus::kPrediction, 2);
  const auto fit = focused(seen, channels, ArxFocus::kAuto, 2);
  ASSERT_TRUE(fit.outcome.refined);
  ASSERT_EQ(fit.outcome.choices.size(), 1U);
  EXPECT_EQ(fit.outcome.choices[0].candidates[fit.outcome.choices[0].chosen].states, 6);
  EXPECT_LT(fit.fit.summary.effective[0], 12);
  EXPECT_LT(fit.fit.summary.stable.radius, 1);
  const auto before = free_run_fits(squares.fit.model, unseen, channels);
  const auto after = free_run_fits(fit.fit.model, unseen, channels);
  EXPECT_LT(*std::min_element(before.begin(), before.end()), 80);
  EXPECT_GT(*std::min_element(after.begin(), after.end()), 93);
  const auto kept = focused(seen, channels, ArxFocus::kSimulation, 2);
  EXPECT_EQ(kept.fit.model.orders.na(0, 0), 2);
}

TEST(FocusOnStates, DataThatDoNotTellAllCoefficientsMayTellAState) {
  const StateSpace truth = structure(6, 2, 31);
  const ChannelChoice channels = channels_of(truth);
  const Recording seen = record(truth, 600, 32, 0), unseen = record(truth, 400, 33, 0);
  const auto squares = focused(seen, channels, ArxFocus::kPrediction, 2);
  EXPECT_FALSE(squares.fit.summary.rank_problems.empty());
  EXPECT_FALSE(squares.fit.summary.usable.verdict);
  const auto fit = focused(seen, channels, ArxFocus::kAuto, 2);
  ASSERT_TRUE(fit.outcome.refined);
  EXPECT_TRUE(fit.fit.summary.usable.verdict) << fit.fit.summary.usable.reason;
  const auto after = free_run_fits(fit.fit.model, unseen, channels);
  EXPECT_GT(*std::min_element(after.begin(), after.end()), 99);
}

TEST(FocusOnStates, OutputsThatDoNotRememberEachOtherHaveNoStateInCommon) {
  const StateSpace truth = structure(4, 2, 41);
  const ChannelChoice channels = channels_of(truth);
  const Recording seen = record(truth, 700, 42, 0.1);
  ArxOptions options{.orders = {OrderMatrix(4, 4, 2), OrderMatrix(4, 2, 2), OrderMatrix(4, 2, 1)}};
  options.orders.na(0, 3) = options.orders.na(3, 0) = 0;  // a chain
  auto plain = fit_arx({&seen, 1}, channels, options);
  ASSERT_TRUE(plain);
  const auto fit = arx::focus_fit({&seen, 1}, channels, options, std::move(*plain), {ArxFocus::kAuto}, {});
  ASSERT_TRUE(fit);
  for (const arx::FocusChoice& choice : fit->outcome.choices) {
    for (const arx::FocusCandidate& one : choice.candidates) EXPECT_TRUE(one.states == 0 || choice.outputs.size() == 1);
  }
}

}  // namespace
}  // namespace wisp::subspace_test
