#include "learn/fit/arx_report.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

#include "learn/judge/judged_fit.hpp"
#include "learn/judge/response.hpp"
#include "learn/rows/arx_design.hpp"

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

TEST(MakeStable, OrderOneGoesToTheRadiusAndBFollows) {
  const ArxOrders orders = make_orders({.outputs = 1, .inputs = 1, .na = 1, .nb = 1, .nk = 1});
  ArxModel model = model_with({{-1.1, 2.0}}, orders);
  Eigen::Matrix2d inverse;
  inverse << 2, 0.5, 0.5, 1;
  make_stable(model, {inverse}, kMax);
  EXPECT_NEAR(model.theta[0][0], -kMax, 1e-9);
  EXPECT_NEAR(model.theta[0][1], 2.0 + 0.5 / 2 * 0.101, 1e-9);
}

TEST(MakeStable, ManyPolesAreScaledInwardsAlike) {
  constexpr int kOrder = 120;
  const ArxOrders orders = make_orders({.outputs = 1, .inputs = 0, .na = kOrder, .nb = 0, .nk = 0});
  std::vector<double> theta(kOrder);
  theta[kOrder - 1] = -std::pow(1.02, kOrder);  // poles on a circle of radius 1.02
  ArxModel model = model_with({theta}, orders);
  make_stable(model, {Eigen::MatrixXd::Identity(kOrder, kOrder)}, kMax);
  EXPECT_NEAR(model.theta[0][kOrder - 1], -std::pow(kMax, kOrder), 1e-9);
}

TEST(MakeStable, OutputsThatFeedEachOtherKeepTheirPolesDirections) {
  const ArxOrders orders = make_orders({.outputs = 2, .inputs = 0, .na = 2, .nb = 0, .nk = 0});
  ArxModel model = model_with({{-1.2, 0.3, 0.6, -0.2}, {0.4, -0.1, -0.9, 0.5}}, orders);
  const auto before = poles(model);
  double radius = 0;
  for (const auto& pole : before) radius = std::max(radius, std::abs(pole));
  ASSERT_GT(radius, 1.02);
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(4, 4);
  make_stable(model, {one, one}, kMax);
  const auto after = poles(model);
  ASSERT_EQ(after.size(), before.size());
  for (const auto& pole : before) {
    EXPECT_TRUE(std::any_of(after.begin(), after.end(), [&](const auto& other) {
      return std::abs(other - pole * (kMax / radius)) < 1e-9;
    })) << pole;
  }
}

TEST(MakeStable, BlocksThatAreStableStayAsTheyAre) {
  const ArxOrders orders =
      make_orders({.outputs = 2, .inputs = 0, .na = 1, .nb = 0, .nk = 0, .coupling = Coupling::kDiagonal});
  ArxModel model = model_with({{-0.5}, {-1.2}}, orders);
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(1, 1);
  make_stable(model, {one, one}, kMax);
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
