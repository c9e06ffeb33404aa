// Dynamics of a whole outline through the components of its shape.

#include "learn/outline/outline_components.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "learn/outline/made_outline.hpp"
#include "learn/outline/outline_fit.hpp"
#include "learn/outline/outline_orders.hpp"

namespace wisp::outline_components_test {
namespace {

constexpr made::OutlineRecipe kWindy{.points = 6, .rows = 1500, .shock = 0.003, .wind = true};

PreparedOutlines prepared(const made::OutlineRecipe& recipe = kWindy) {
  const Recording recording = made::outline_recording(recipe);
  auto out = prepare_outlines({&recording, 1}, {.shape = {.split_sign = true, .powers = true}});
  EXPECT_TRUE(out) << out.error().message;
  return *std::move(out);
}

TEST(OutlineComponents, TogetherTheyAreTheOutline) {
  const PreparedOutlines outlines = prepared();
  const ShapeComponents components = shape_components(outlines.recordings, outlines);
  ASSERT_EQ(components.names.size(), 10u);  // of 12 coordinates two mirror two others
  const Recording& recording = outlines.recordings.front();
  Eigen::VectorXd away(12);
  double square = 0, rows = 0;
  for (std::size_t row = 0; row < recording.rows(); row += 10) {
    for (Eigen::Index k = 0; k < 12; ++k) {
      const auto place = static_cast<std::size_t>(k);
      away[k] = recording.channels[outlines.layout.outputs[place]].samples[row] - components.rest[place];
    }
    const Eigen::VectorXd score = components.score * away;
    EXPECT_LT((components.shape * score - away).norm(), 1e-6 + 1e-6 * away.norm()) << row;
    square += score.squaredNorm();
    ++rows;
  }
  EXPECT_NEAR(square / rows / 10, 1, 0.6);  // each of variance 1 about the mean, which is near the calm shape
}

Result<ArxFit> fitted(const PreparedOutlines& outlines, double mirror_weight) {
  const ArxOrders orders = outline_orders(2, 0, OutlineCoupling::kFull, outlines);
  auto fit = fit_components(outlines.recordings, outlines, {orders, 1e-4, mirror_weight});
  if (!fit) return fit.error();
  return std::move(*fit);
}

TEST(OutlineComponents, TheLastPointMirrorsTheFirstToTheLastBit) {
  const auto fit = fitted(prepared(), 1);
  ASSERT_TRUE(fit) << fit.error().message;
  for (std::size_t k : {0, 1}) {
    ASSERT_EQ(fit->model.theta[k].size(), fit->model.theta[10 + k].size());
    for (std::size_t c = 0; c < fit->model.theta[k].size(); ++c) {
      EXPECT_EQ(fit->model.theta[10 + k][c], -fit->model.theta[k][c]) << c;
    }
    EXPECT_EQ(fit->model.output_mean[10 + k], -fit->model.output_mean[k]);
  }
}

// A gust from the other side: the same coordinates' answers, mirrored.
TEST(OutlineComponents, AWholeMirrorImageMakesBothSidesAlike) {
  const auto fit = fitted(prepared(), 1);
  ASSERT_TRUE(fit) << fit.error().message;
  const ArxModel& model = fit->model;
  for (int i = 0; i < 12; ++i) {
    const int other = 2 * (5 - i / 2) + i % 2;
    for (int k = 0; k < 3; ++k) {
      for (std::size_t lag = 0; lag < model.b(i, k).size(); ++lag) {
        const double mirrored = (i % 2 == 0 ? -1 : 1) * model.b(other, 3 + k)[lag];
        EXPECT_NEAR(model.b(i, k)[lag], mirrored, 5e-4) << i << ' ' << k;
      }
    }
  }
}

TEST(OutlineComponents, WhatIsGuessedWeighsLittle) {
  const auto alone = fitted(prepared(), 0), guessed = fitted(prepared(), 0.1), whole = fitted(prepared(), 1);
  ASSERT_TRUE(alone && guessed && whole);
  double near = 0, far = 0;
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      near += std::abs(guessed->model.a(i, j)[0] - alone->model.a(i, j)[0]);
      far += std::abs(whole->model.a(i, j)[0] - alone->model.a(i, j)[0]);
    }
  }
  EXPECT_LT(near, 0.7 * far);
}

TEST(OutlineComponents, AreTheDefaultFromTwentySecondsOfWindOn) {
  const auto coefficients = [](std::size_t rows, const OutlineRecipe& recipe) {
    const auto fit =
        fit_outline(std::vector{made::outline_recording({.points = 6, .rows = rows, .wind = true})}, recipe);
    EXPECT_TRUE(fit) << fit.error().message;
    return fit->summary.orders.row_size(0);
  };
  EXPECT_EQ(coefficients(900, {}), 2 * 10 + 2 * (4 + 2 + 2));
  EXPECT_EQ(coefficients(900, {.light = true}), 3 + 2 * 3);
  EXPECT_EQ(coefficients(450, {}), 3 + 2 * 3);
}

// In another flame's wind one step ahead is good and a free run is not.
TEST(OutlineComponents, WarningsNameCoordinates) {
  Recording recording = made::outline_recording(kWindy);
  recording.channels[*find_channel(recording, "wind")].samples = made::gusts({.rows = 1500, .seed = 9});
  const auto fit = fit_outline(std::vector{recording}, {});
  ASSERT_TRUE(fit) << fit.error().message;
  std::string all;
  for (const std::string& warning : fit->summary.warnings) all += warning + '\n';
  EXPECT_THAT(all, testing::HasSubstr("output 'p2.x': one step ahead"));
  EXPECT_THAT(all, testing::Not(testing::HasSubstr("component")));
}

}  // namespace
}  // namespace wisp::outline_components_test
