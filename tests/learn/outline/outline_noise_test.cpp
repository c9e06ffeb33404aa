#include "learn/outline/outline_noise.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "learn/arx/rows/arx_orders.hpp"

namespace wisp::outline_noise_test {
namespace {

// Independent channels y(t) = poles[i] · y(t−1) + e(t).
ArxModel first_order(const std::vector<double>& poles) {
  const int ny = static_cast<int>(poles.size());
  ArxModel model;
  model.orders = make_orders({.outputs = ny, .inputs = 0, .na = 1, .nb = 0, .coupling = Coupling::kDiagonal});
  for (double pole : poles) model.theta.push_back({-pole});
  model.constant.assign(poles.size(), 0.0);
  model.output_mean.assign(poles.size(), 0.0);
  model.noise.sd.assign(poles.size(), 0.0);
  return model;
}

// Two points of two coupled outputs each, of second order.
ArxModel two_points() {
  ArxModel model;
  model.orders =
      make_orders({.outputs = 4, .inputs = 0, .na = 2, .nb = 0, .coupling = Coupling::kDiagonal, .group = 2});
  model.theta = {{-1.2, 0.5, 0.1, 0.0}, {0.0, 0.1, -0.8, 0.2}, {-1.0, 0.6, -0.1, 0.1}, {0.1, 0.0, -0.5, 0.3}};
  model.constant.assign(4, 0.0);
  model.output_mean.assign(4, 0.0);
  model.noise.sd.assign(4, 0.0);
  return model;
}

Covariance some_covariance() {
  Covariance out(4, 4);
  out << 4, 1, 2, 0.5, 1, 2, 0.3, 1, 2, 0.3, 3, 0.2, 0.5, 1, 0.2, 1;
  return out;
}

TEST(OutlineNoise, FirstOrderVarianceIsTheGeometricSeries) {
  Covariance shocks(2, 2);
  shocks << 2, 0.5, 0.5, 1;
  const Covariance p = stationary_covariance(first_order({0.9, -0.4}), shocks);
  EXPECT_NEAR(p(0, 0), 2 / (1 - 0.81), 1e-9);
  EXPECT_NEAR(p(1, 1), 1 / (1 - 0.16), 1e-12);
  EXPECT_NEAR(p(0, 1), 0.5 / (1 + 0.36), 1e-12);
  EXPECT_EQ(p(0, 1), p(1, 0));
}

TEST(OutlineNoise, StationaryCovarianceSolvesTheLyapunovEquation) {
  const ArxModel model = two_points();
  const Covariance shocks = some_covariance();
  // The whole state (y(t), y(t−1)) by iteration of P = F P Fᵀ + G.
  Eigen::MatrixXd f = Eigen::MatrixXd::Zero(8, 8);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const auto lags = model.a(i, j);
      for (std::size_t lag = 0; lag < lags.size(); ++lag) f(i, static_cast<int>(lag) * 4 + j) = -lags[lag];
    }
  }
  f.bottomLeftCorner(4, 4).setIdentity();
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(8, 8);
  g.topLeftCorner(4, 4) = shocks;
  Eigen::MatrixXd p = g;
  for (int k = 0; k < 2000; ++k) p = f * p * f.transpose() + g;
  EXPECT_LT((stationary_covariance(model, shocks) - p.topLeftCorner(4, 4)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(OutlineNoise, ShocksForAStationaryCovarianceAreFoundAgain) {
  const ArxModel model = two_points();
  const Covariance shocks = some_covariance();
  const Covariance found = shocks_for(model, stationary_covariance(model, shocks));
  // The small weight on size costs about its own size, 1e-4.
  EXPECT_LT((found - shocks).cwiseAbs().maxCoeff(), 2e-3);
}

TEST(OutlineNoise, FullRankFactorGivesTheCovarianceBack) {
  const Covariance shocks = some_covariance();
  const Eigen::MatrixXd factor = shared_factor(shocks, 4);
  EXPECT_LT((factor * factor.transpose() - shocks).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(OutlineNoise, OneShockMovesAllChannelsTogether) {
  Covariance shocks(2, 2);
  shocks << 4, -2, -2, 1;
  const Eigen::MatrixXd factor = shared_factor(shocks, 1);
  ASSERT_EQ(factor.cols(), 1);
  EXPECT_NEAR(factor(0, 0) / factor(1, 0), -2, 1e-12);
}

TEST(OutlineNoise, NegativePartsAreLeftOut) {
  Covariance indefinite(2, 2);
  indefinite << 1, 2, 2, 1;
  const Eigen::MatrixXd factor = shared_factor(indefinite, 2);
  const Covariance made = factor * factor.transpose();
  EXPECT_NEAR(made(0, 0), 1.5, 1e-12);
  EXPECT_NEAR(made(0, 1), 1.5, 1e-12);
}

TEST(OutlineNoise, AChannelThatNeverMovesStaysStill) {
  Covariance shocks = Covariance::Zero(2, 2);
  shocks(0, 0) = 1;
  const Eigen::MatrixXd factor = shared_factor(shocks, 2);
  EXPECT_TRUE(factor.allFinite());
  EXPECT_EQ(factor.row(1).cwiseAbs().maxCoeff(), 0);
}

TEST(OutlineNoise, ScalingReachesEveryVariance) {
  const ArxModel model = two_points();
  const Covariance wanted = 3 * some_covariance();
  Eigen::MatrixXd factor = shared_factor(some_covariance(), 3);
  EXPECT_TRUE(scale_to_variance(model, wanted, factor));
  const Covariance reached = stationary_covariance(model, factor * factor.transpose());
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(reached(i, i) / wanted(i, i), 1, 1e-5) << i;
}

// The promise as a simulation keeps it, 200 000 steps: the relative error of a variance over n steps with a memory of
// about 10 is near sqrt(20/n) = 0.01; six of those are the bound.
TEST(OutlineNoise, ASimulationHasTheVarianceThatWasPromised) {
  const ArxModel model = two_points();
  Eigen::MatrixXd factor = shared_factor(some_covariance(), 2);
  ASSERT_TRUE(scale_to_variance(model, some_covariance(), factor));
  std::mt19937_64 random(1);
  std::normal_distribution<double> gauss;
  Eigen::VectorXd last = Eigen::VectorXd::Zero(4);
  Eigen::VectorXd before = last;
  Eigen::VectorXd squares = last;
  constexpr int kSteps = 200000;
  for (int t = 0; t < kSteps; ++t) {
    Eigen::VectorXd now = factor * Eigen::Vector2d(gauss(random), gauss(random));
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        const auto lags = model.a(i, j);
        if (!lags.empty()) now[i] -= lags[0] * last[j] + lags[1] * before[j];
      }
    }
    before = last;
    last = now;
    squares += now.cwiseAbs2();
  }
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(squares[i] / kSteps / some_covariance()(i, i), 1, 0.06) << i;
}

}  // namespace
}  // namespace wisp::outline_noise_test
