#include "learn/judge/prediction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "learn/arx/made_system.hpp"
#include "learn/rows/arx_design.hpp"

namespace wisp::prediction_test {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kHistory = 3;  // of made_system

const ChannelChoice kChannels{{"u1", "u2"}, {"y1", "y2"}};

// By the definition: outputs after t − k are predicted one after the other, each from those before it.
double predicted_by_hand(const ArxModel& model, const Recording& recording, std::size_t t, std::size_t k, int output) {
  std::vector<std::vector<double>> y;
  for (int i : {0, 1}) {
    y.push_back(recording.channels[2 + i].samples);
    for (double& sample : y.back()) sample -= model.output_mean[i];
  }
  for (std::size_t s = t - k + 1; s <= t; ++s) {
    double next[2] = {};
    for (int i : {0, 1}) {
      for (int j : {0, 1}) {
        const auto a = model.a(i, j), b = model.b(i, j);
        for (std::size_t l = 0; l < a.size(); ++l) next[i] -= a[l] * y[j][s - 1 - l];
        const auto delay = static_cast<std::size_t>(model.orders.nk(i, j));
        for (std::size_t l = 0; l < b.size(); ++l) {
          next[i] += b[l] * (recording.channels[j].samples[s - delay - l] - model.input_mean[j]);
        }
      }
    }
    y[0][s] = next[0], y[1][s] = next[1];
  }
  return y[output][t] + model.output_mean[output];
}

TEST(Predict, AnyNumberOfStepsIsTheRecursionByHand) {
  const ArxModel model = made_system();
  const Recording recording = record_system(model, 80, 1);
  for (std::size_t k : {1u, 2u, 7u, 40u}) {
    const auto got = predict(model, recording, kChannels, {.steps = static_cast<int>(k)});
    ASSERT_TRUE(got);
    for (int i : {0, 1}) {
      for (std::size_t t = 0; t < 80; ++t) {
        if (t < kHistory + k - 1) {
          EXPECT_TRUE(std::isnan((*got)[i][t])) << k << " " << t;
        } else {
          EXPECT_NEAR((*got)[i][t], predicted_by_hand(model, recording, t, k, i), 1e-11) << k << " " << t;
        }
      }
    }
  }
}

TEST(Predict, FreeSimulationIsThePredictionFromTheFirstRowsAlone) {
  const ArxModel model = made_system();
  const Recording recording = record_system(model, 60, 2);
  const auto got = predict(model, recording, kChannels, {.steps = kFreeRun});
  ASSERT_TRUE(got);
  for (int i : {0, 1}) {
    for (std::size_t t = 0; t < kHistory; ++t) EXPECT_TRUE(std::isnan((*got)[i][t]));
    for (std::size_t t = kHistory; t < 60; ++t) {
      EXPECT_NEAR((*got)[i][t], predicted_by_hand(model, recording, t, t - kHistory + 1, i), 1e-11) << t;
    }
  }
}

TEST(Predict, NeedsNoOutputsInFreeSimulationButStartsAgainAfterAGapInAnInput) {
  const ArxModel model = made_system();
  const Recording whole = record_system(model, 60, 3);
  Recording recording = whole;
  recording.channels[3].samples[20] = kMissing;
  recording.channels[0].samples[40] = kMissing;
  const auto got = predict(model, recording, kChannels, {.steps = kFreeRun});
  const auto want = predict(model, whole, kChannels, {.steps = kFreeRun});
  ASSERT_TRUE(got && want);
  for (std::size_t t = kHistory; t < 40; ++t) EXPECT_EQ((*got)[1][t], (*want)[1][t]);
  // u1 enters y1 at lags 1 and 2.
  EXPECT_FALSE(std::isnan((*got)[0][40]));
  for (std::size_t t : {41u, 42u}) EXPECT_TRUE(std::isnan((*got)[0][t]));
  for (std::size_t t = 43; t < 60; ++t) {
    EXPECT_NEAR((*got)[0][t], predicted_by_hand(model, whole, t, t - 42, 0), 1e-11);
  }
}

TEST(Predict, NothingCrossesFromOneEpisodeToTheNext) {
  const ArxModel model = made_system();
  Recording recording = record_system(model, 60, 4);
  for (std::size_t t = 0; t < 60; ++t) recording.episode_ids.push_back(t < 30 ? 5 : 6);
  const auto got = predict(model, recording, kChannels, {.steps = 4});
  ASSERT_TRUE(got);
  for (std::size_t t = 30; t < 30 + kHistory + 3; ++t) EXPECT_TRUE(std::isnan((*got)[0][t])) << t;
  EXPECT_FALSE(std::isnan((*got)[0][30 + kHistory + 3]));
}

TEST(Predict, AnEstimatedStartIsTheOneThatFitsBest) {
  const ArxModel model = made_system();
  // Without noise, and seen after it has been running: the true start explains all.
  const Recording recording = slice(record_system(model, 300, 5, 0), 100, 300);
  const auto error = [&](InitialState initial) {
    FigureOptions options;
    options.steps = {kFreeRun};
    options.initial = initial;
    return prediction_figures(model, {&recording, 1}, kChannels, options)->front().mean_square[0];
  };
  EXPECT_LT(error(InitialState::kEstimated), 1e-20);
  EXPECT_LT(error(InitialState::kMeasured), 1e-20);
  EXPECT_GT(error(InitialState::kZero), 1e-4);
}

// What the inputs of the first rows do is part of a simulation from rest.
TEST(Predict, FromRestBeginsAtTheFirstRow) {
  ArxModel model = made_system();
  model.output_mean.assign(model.output_mean.size(), 0), model.input_mean.assign(model.input_mean.size(), 0);
  Recording recording = record_system(model, 300, 5, 0);
  const auto whole = predict(model, recording, kChannels, {.steps = kFreeRun, .initial = InitialState::kZero});
  ASSERT_TRUE(whole);
  EXPECT_FALSE(std::isnan((*whole)[0][0]));
  // Preceded by rows at rest it is the same.
  for (Channel& channel : recording.channels) channel.samples.insert(channel.samples.begin(), 20, 0.0);
  for (RowFlag& flag : recording.flags) flag.rows.insert(flag.rows.begin(), 20, std::uint8_t{0});
  const auto rested = predict(model, recording, kChannels, {.steps = kFreeRun, .initial = InitialState::kZero});
  ASSERT_TRUE(rested);
  for (std::size_t t = 0; t < 300; ++t) EXPECT_NEAR((*rested)[0][t + 20], (*whole)[0][t], 1e-9) << t;
}

TEST(Predict, AnEstimatedStartBeatsANoisyMeasuredOne) {
  const ArxModel model = made_system();
  Recording recording = slice(record_system(model, 300, 6, 0), 100, 160);
  for (std::size_t t = 0; t < kHistory; ++t) recording.channels[2].samples[t] += 3;  // bad samples at the start
  FigureOptions options;
  options.steps = {kFreeRun};
  const auto measured = prediction_figures(model, {&recording, 1}, kChannels, options);
  options.initial = InitialState::kEstimated;
  const auto estimated = prediction_figures(model, {&recording, 1}, kChannels, options);
  ASSERT_TRUE(measured && estimated);
  EXPECT_LT(estimated->front().mean_square[0], 1e-6 * measured->front().mean_square[0]);
}

TEST(PredictionFigures, AreThoseOfTheirDefinitions) {
  const ArxModel model = made_system();
  const Recording recording = record_system(model, 3000, 7);  // more than two blocks
  FigureOptions options;
  options.steps = {3, 1, kFreeRun};
  const auto figures = prediction_figures(model, {&recording, 1}, kChannels, options);
  ASSERT_TRUE(figures);
  for (const PredictionFigures& got : *figures) {
    const auto predicted = predict(model, recording, kChannels, {.steps = got.steps});
    double rows = 0, size[2] = {}, square[2] = {}, sum[2] = {}, sum_square[2] = {};
    for (std::size_t t = 0; t < recording.rows(); ++t) {
      if (std::isnan((*predicted)[0][t])) continue;
      for (int i : {0, 1}) {
        const double y = recording.channels[2 + i].samples[t];
        const double error = y - (*predicted)[i][t];
        size[i] += std::abs(error);
        square[i] += error * error;
        sum[i] += y;
        sum_square[i] += y * y;
      }
      ++rows;
    }
    EXPECT_EQ(got.rows, static_cast<std::size_t>(rows));
    for (int i : {0, 1}) {
      EXPECT_NEAR(got.j[i], size[i] / rows, 1e-12);
      EXPECT_NEAR(got.mean_square[i], square[i] / rows, 1e-12);
      const double spread = sum_square[i] - sum[i] * sum[i] / rows;
      EXPECT_NEAR(got.fit_percent[i], 100 * (1 - std::sqrt(square[i] / spread)), 1e-7);
    }
  }
}

TEST(PredictionFigures, SayWhatIsWrong) {
  const ArxModel model = made_system();
  const Recording recording = record_system(model, 50, 8);
  FigureOptions options;
  const auto fails = [&](const Recording& of, const ChannelChoice& channels) {
    return !prediction_figures(model, {&of, 1}, channels, options);
  };
  EXPECT_FALSE(fails(recording, kChannels));
  EXPECT_TRUE(fails(recording, {{"u1"}, {"y1", "y2"}}));
  EXPECT_TRUE(fails(recording, {{"u1", "u9"}, {"y1", "y2"}}));
  EXPECT_TRUE(fails(slice(recording, 0, 3), kChannels));
  options.steps = {-1};
  EXPECT_TRUE(fails(recording, kChannels));
  options = {};
  options.first_sample = 2;
  EXPECT_TRUE(fails(recording, kChannels));
}

TEST(PredictionSd, OfOrderOneIsTheGeometricSum) {
  ArxModel model;
  model.orders = make_orders({.outputs = 1, .inputs = 0, .na = 1, .nb = 0, .nk = 0});
  model.theta = {{-0.8}};
  model.constant = model.output_mean = {0};
  model.noise.sd = {2};
  const auto sd = prediction_sd(model, 30);
  for (int k = 1; k <= 30; ++k) {
    EXPECT_NEAR(sd[0][k - 1], 2 * std::sqrt((1 - std::pow(0.64, k)) / (1 - 0.64)), 1e-12) << k;
  }
}

TEST(PredictionSd, IntervalsHoldAsOftenAsTheySay) {
  const ArxModel model = made_system();
  const Recording recording = record_system(model, 40000, 9);
  const auto sd = prediction_sd(model, 10);
  for (int k : {1, 3, 10}) {
    const auto predicted = predict(model, recording, kChannels, {.steps = k});
    for (int i : {0, 1}) {
      int rows = 0, inside = 0;
      for (std::size_t t = kHistory + 9; t < recording.rows(); ++t, ++rows) {
        inside += std::abs(recording.channels[2 + i].samples[t] - (*predicted)[i][t]) < 1.959964 * sd[i][k - 1];
      }
      // A share of 40000 is known to 0.0011; correlated over some ten rows, to 0.0034; four of these.
      EXPECT_NEAR(inside / static_cast<double>(rows), 0.95, 0.014) << k << " " << i;
    }
  }
}

}  // namespace
}  // namespace wisp::prediction_test
