#include "learn/arx/fit/arx_stability.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <random>

#include "learn/arx/fit/arx_fit.hpp"
#include "learn/arx/rows/arx_orders.hpp"

namespace wisp::arx_stability_test {
namespace {

constexpr double kMax = 0.999;

ArxModel model_with(std::vector<std::vector<double>> theta, const ArxOrders& orders) {
  ArxModel model;
  model.orders = orders;
  model.theta = std::move(theta);
  model.constant.assign(model.theta.size(), 0.0);
  return model;
}

double loss(const std::vector<double>& theta, const std::vector<double>& estimate, const Eigen::MatrixXd& inverse) {
  const Eigen::Index size = inverse.rows();
  const Eigen::VectorXd moved =
      Eigen::Map<const Eigen::VectorXd>(theta.data(), size) - Eigen::Map<const Eigen::VectorXd>(estimate.data(), size);
  return moved.dot(inverse.inverse() * moved);
}

TEST(MakeStable, OrderOneGoesToTheBoundaryAndBFollows) {
  const ArxOrders orders = make_orders({.outputs = 1, .inputs = 1, .na = 1, .nb = 1, .nk = 1});
  ArxModel model = model_with({{-1.1, 2.0}}, orders);
  Eigen::Matrix2d inverse;
  inverse << 2, 0.5, 0.5, 1;
  make_stable(model, {{inverse, 1}}, kMax);
  EXPECT_NEAR(model.theta[0][0], -kMax, 1e-9);
  EXPECT_NEAR(model.theta[0][1], 2.0 + 0.5 / 2 * 0.101, 1e-9);
}

TEST(MakeStable, ManyPolesAreScaledInwardsAlike) {
  constexpr int kOrder = 120;
  const ArxOrders orders = make_orders({.outputs = 1, .inputs = 0, .na = kOrder, .nb = 0, .nk = 0});
  std::vector<double> theta(kOrder);
  theta[kOrder - 1] = -std::pow(1.02, kOrder);  // poles on a circle of radius 1.02
  ArxModel model = model_with({theta}, orders);
  make_stable(model, {{Eigen::MatrixXd::Identity(kOrder, kOrder), 1}}, kMax);
  EXPECT_NEAR(model.theta[0][kOrder - 1], -std::pow(kMax, kOrder), 1e-9);
}

TEST(MakeStable, OrderTwoFindsTheLeastLossOfAllStablePolynomials) {
  const ArxOrders orders = make_orders({.outputs = 1, .inputs = 0, .na = 2, .nb = 0, .nk = 0});
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 20; ++trial) {
    const double a1 = 2 * normal(generator);
    const double a2 = 1.3 * normal(generator);
    const ArxModel estimate = model_with({{a1, a2}}, orders);
    if (spectral_radius(estimate) < 1) continue;
    const Eigen::Matrix2d root = Eigen::Matrix2d::NullaryExpr([&] { return normal(generator); });
    const Eigen::Matrix2d inverse = root * root.transpose() + 0.1 * Eigen::Matrix2d::Identity();
    ArxModel model = estimate;
    make_stable(model, {{inverse, 1}}, kMax);
    ASSERT_LT(spectral_radius(model), 1);  // in single precision
    // The stable polynomials are a triangle: |a2| <= r², |a1| <= r + a2/r. Its edges in steps of a thousandth.
    double least = std::numeric_limits<double>::infinity();
    for (int step = 0; step <= 1000; ++step) {
      const double b2 = kMax * kMax * (2 * step / 1000.0 - 1);
      const double b1 = kMax + b2 / kMax;
      least =
          std::min({least, loss({b1, b2}, estimate.theta[0], inverse), loss({-b1, b2}, estimate.theta[0], inverse)});
      const double top = 2 * kMax * (2 * step / 1000.0 - 1);
      least = std::min(least, loss({top, kMax * kMax}, estimate.theta[0], inverse));
    }
    EXPECT_LE(loss(model.theta[0], estimate.theta[0], inverse), least * 1.01) << trial;
  }
}

// Two outputs that feed each other, with an unstable pair of poles.
TEST(MakeStable, CoupledOutputsLoseLessThanByScalingAllPoles) {
  const ArxOrders orders = make_orders({.outputs = 2, .inputs = 0, .na = 2, .nb = 0, .nk = 0});
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  int tried = 0;
  double gain = 0;
  for (int trial = 0; trial < 60 && tried < 20; ++trial) {
    std::vector<std::vector<double>> theta(2);
    for (auto& row : theta) {
      for (int p = 0; p < 4; ++p) row.push_back(0.7 * normal(generator));
    }
    const ArxModel estimate = model_with(theta, orders);
    const double radius = spectral_radius(estimate);
    if (radius < 1.02 || radius > 1.5) continue;
    ++tried;
    std::vector<RowCurvature> curvature;
    for (int i = 0; i < 2; ++i) {
      const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(4, 4, [&] { return normal(generator); });
      curvature.push_back({root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(4, 4), 1});
    }
    ArxModel model = estimate;
    ArxModel scaled = estimate;
    const double reported = make_stable(model, curvature, kMax);
    scale_poles(scaled, kMax / radius);
    double ours = 0;
    double theirs = 0;
    for (int i = 0; i < 2; ++i) {
      ours += loss(model.theta[i], estimate.theta[i], curvature[i].inverse);
      theirs += loss(scaled.theta[i], estimate.theta[i], curvature[i].inverse);
    }
    EXPECT_LE(spectral_radius(model), kMax + 1e-5);
    EXPECT_NEAR(reported, ours, 1e-6 * ours);
    EXPECT_LE(ours, theirs * 1.0001);
    gain += std::log(theirs / ours) / 20;
  }
  EXPECT_EQ(tried, 20);
  EXPECT_GT(std::exp(gain), 2);  // in the geometric mean less than half of what scaling loses
}

TEST(MakeStable, BlocksThatAreStableStayAsTheyAre) {
  const ArxOrders orders =
      make_orders({.outputs = 2, .inputs = 0, .na = 1, .nb = 0, .nk = 0, .coupling = Coupling::kDiagonal});
  ArxModel model = model_with({{-0.5}, {-1.2}}, orders);
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(1, 1);
  make_stable(model, {{one, 1}, {one, 1}}, kMax);
  EXPECT_EQ(model.theta[0][0], -0.5);
  EXPECT_NEAR(model.theta[1][0], -kMax, 1e-9);
}

// A random walk with drift, over which least squares finds a pole outside the circle.
Recording growing(std::size_t rows) {
  std::mt19937 generator(9);
  std::normal_distribution<double> normal;
  Recording recording;
  recording.rate_hz = 1;
  std::vector<double> u(rows), y(rows);
  for (std::size_t t = 0; t < rows; ++t) {
    u[t] = normal(generator);
    if (t > 0) y[t] = 1.02 * y[t - 1] + 0.5 * u[t - 1] + 0.1 * normal(generator);
  }
  recording.channels = {{"u", "", Role::kInput, u}, {"y", "", Role::kOutput, y}};
  return recording;
}

TEST(StableFit, UnstableEstimateIsRepairedAndSaysSo) {
  const Recording recording = growing(200);
  ArxOptions options;
  options.orders = make_orders({.outputs = 1, .inputs = 1, .na = 2, .nb = 2, .nk = 1});
  options.offset = ArxOffset::kNone;
  const auto fit = fit_arx({&recording, 1}, {{"u"}, {"y"}}, options);
  ASSERT_TRUE(fit);
  EXPECT_TRUE(fit->summary.stable.changed);
  EXPECT_GT(fit->summary.stable.estimated, 1.01);
  EXPECT_LT(fit->summary.stable.radius, 1);
  EXPECT_EQ(fit->summary.stable.radius, spectral_radius(fit->model));
  EXPECT_GT(fit->summary.stable.loss_factor, 1);
  EXPECT_TRUE(fit->summary.usable.verdict);
  ASSERT_FALSE(fit->summary.warnings.empty());
  EXPECT_NE(fit->summary.warnings[0].find("was made stable"), std::string::npos);
}

TEST(StableFit, FiguresAreThoseOfTheRepairedModel) {
  const Recording recording = growing(200);
  ArxOptions options;
  options.orders = make_orders({.outputs = 1, .inputs = 1, .na = 1, .nb = 1, .nk = 1});
  options.offset = ArxOffset::kNone;
  const auto fit = fit_arx({&recording, 1}, {{"u"}, {"y"}}, options);
  ASSERT_TRUE(fit);
  double square = 0;
  for (std::size_t t = 1; t < 200; ++t) {
    const double residual = recording.channels[1].samples[t] +
                            fit->model.theta[0][0] * recording.channels[1].samples[t - 1] -
                            fit->model.theta[0][1] * recording.channels[0].samples[t - 1];
    square += residual * residual;
  }
  EXPECT_NEAR(fit->summary.loss[0] / (square / 199), 1, 1e-10);
}

TEST(StableFit, UnstableEstimateIsLeftAloneWhereAskedAndIsNotUsable) {
  const Recording recording = growing(200);
  ArxOptions options;
  options.orders = make_orders({.outputs = 1, .inputs = 1, .na = 2, .nb = 2, .nk = 1});
  options.offset = ArxOffset::kNone;
  options.stabilise = false;
  const auto fit = fit_arx({&recording, 1}, {{"u"}, {"y"}}, options);
  ASSERT_TRUE(fit);
  EXPECT_FALSE(fit->summary.stable.changed);
  EXPECT_GT(fit->summary.stable.radius, 1);
  EXPECT_FALSE(fit->summary.usable.verdict);
  EXPECT_NE(fit->summary.usable.reason.find("unstable"), std::string::npos);
}

}  // namespace
}  // namespace wisp::arx_stability_test
