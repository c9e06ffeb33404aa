#include "learn/rows/lag_gram.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "learn/rows/arx_design.hpp"

namespace wisp::lag_gram_test {
namespace {

Recording noise(std::size_t rows, int outputs, int inputs, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Recording recording;
  recording.rate_hz = 1;
  for (int c = 0; c < outputs + inputs; ++c) {
    const bool output = c < outputs;
    recording.channels.push_back({std::string(output ? "y" : "u") + std::to_string(output ? c : c - outputs), "",
                                  output ? Role::kOutput : Role::kInput, std::vector<double>(rows)});
    for (double& sample : recording.channels.back().samples) sample = 3 + normal(generator);
  }
  return recording;
}

ChannelChoice choice(int outputs, int inputs) {
  ChannelChoice channels;
  for (int i = 0; i < outputs; ++i) channels.outputs.push_back(std::string("y") + std::to_string(i));
  for (int k = 0; k < inputs; ++k) channels.inputs.push_back(std::string("u") + std::to_string(k));
  return channels;
}

// The regressor written out, row by row.
Eigen::MatrixXd rows_of(const Signals& signals, const RowPlan& plan, const LagLayout& layout) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(plan.rows), layout.size());
  Eigen::Index at = 0;
  for (const RowRun& run : plan.runs) {
    for (std::size_t t = run.begin; t < run.end; ++t, ++at) {
      rows(at, 0) = 1;
      for (int p = 1; p < layout.size(); ++p) {
        const auto [channel, lag] = layout[p];
        rows(at, p) =
            (signals.samples[run.recording][channel][t - lag] - signals.offset[channel]) * signals.scale[channel];
      }
    }
  }
  return rows;
}

void expect_exact(const std::vector<Recording>& recordings, const ChannelChoice& channels, const ArxOrders& orders) {
  const auto signals = gather_signals(recordings, channels, ArxOffset::kMean);
  ASSERT_TRUE(signals) << signals.error().message;
  const ArxDesign design = make_design(orders, ArxOffset::kEstimate);
  const RowPlan plan = plan_rows(*signals, design.layout, orders.history());
  const Eigen::MatrixXd rows = rows_of(*signals, plan, design.layout);
  const Eigen::MatrixXd want = rows.transpose() * rows;
  const ChannelPairs all = ChannelPairs::Constant(signals->channels(), signals->channels(), true);
  const double tolerance = 1e-13 * want.norm();
  EXPECT_LT((lag_gram(*signals, plan, design.layout, all) - want).cwiseAbs().maxCoeff(), tolerance);
  const Eigen::MatrixXd triangle = triangle_by_qr(*signals, plan, design.layout);
  EXPECT_LT((triangle.transpose() * triangle - want).cwiseAbs().maxCoeff(), tolerance);
}

TEST(LagGram, IsTheGramMatrixOfTheWrittenOutRegressor) {
  expect_exact({noise(5000, 2, 1, 1)}, choice(2, 1),
               make_orders({.outputs = 2, .inputs = 1, .na = 4, .nb = 4, .nk = 1}));
}

TEST(LagGram, HandlesOrderMatricesWithGapsBetweenLags) {
  ArxOrders orders = make_orders({.outputs = 2, .inputs = 2, .na = 3, .nb = 2, .nk = 0});
  orders.na(0, 1) = 0;
  orders.na(1, 0) = 7;
  orders.nk(0, 1) = 5;
  orders.nk(1, 1) = 20;
  orders.nb(1, 0) = 0;
  expect_exact({noise(1500, 2, 2, 2)}, choice(2, 2), orders);
}

TEST(LagGram, KeepsHistoryWithinEpisodesAndRecordings) {
  Recording first = noise(700, 1, 1, 3);
  for (std::size_t t = 0; t < 700; ++t) first.episode_ids.push_back(t < 100 ? 0 : t < 103 ? 1 : 2);
  expect_exact({first, noise(300, 1, 1, 4)}, choice(1, 1),
               make_orders({.outputs = 1, .inputs = 1, .na = 5, .nb = 3, .nk = 2}));
}

TEST(LagGram, LeavesOutRowsThatMissingSamplesEnter) {
  Recording recording = noise(400, 2, 1, 5);
  const double missing = std::numeric_limits<double>::quiet_NaN();
  recording.channels[0].samples[50] = missing;
  recording.channels[1].samples[51] = missing;
  recording.channels[2].samples[0] = missing;
  recording.channels[2].samples[399] = missing;
  recording.channels[0].samples[200] = missing;
  const ArxOrders orders = make_orders({.outputs = 2, .inputs = 1, .na = 3, .nb = 2, .nk = 1});
  expect_exact({recording}, choice(2, 1), orders);
  const auto signals = gather_signals({&recording, 1}, choice(2, 1), ArxOffset::kMean);
  const RowPlan plan = plan_rows(*signals, make_design(orders, ArxOffset::kMean).layout, 3);
  // Rows 50–54 and 200–203 miss an output or its history; the input's first sample is never a regressor of row 3 on,
  // and its last one only of a row that is not there.
  EXPECT_EQ(plan.rows_left_out, 9u);
  EXPECT_EQ(plan.rows, 400u - 3 - 9);
}

}  // namespace
}  // namespace wisp::lag_gram_test
