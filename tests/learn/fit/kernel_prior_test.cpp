#include "learn/fit/arx_estimate.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "learn/judge/judged_fit.hpp"
#include "learn/judge/response.hpp"
#include "learn/rows/arx_design.hpp"

namespace wisp::arx::kernel_prior_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// A response that dies down by `decay` a lag, seen through white inputs and noise.
RegressionProducts seen(int size, int rows, double decay, double noise, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  MatrixXd x(rows, size);
  VectorXd y(rows);
  for (int t = 0; t < rows; ++t) {
    y[t] = noise * normal(generator);
    for (int j = 0; j < size; ++j) {
      x(t, j) = normal(generator);
      y[t] += std::pow(decay, j) * x(t, j);
    }
  }
  return {x.transpose() * x, x.transpose() * y, y.squaredNorm(), static_cast<double>(rows)};
}

TEST(KernelPrior, IsTheInverseOfATunedCorrelatedKernel) {
  const MatrixXd factor = kernel_factor(seen(12, 400, 0.7, 0.5, 1), {{0, 12}});
  const MatrixXd kernel = (factor.transpose() * factor).inverse();
  const double decay = kernel(1, 1) / kernel(0, 0);
  EXPECT_GT(decay, 0.3);
  EXPECT_LT(decay, 0.9);
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 12; ++j) {
      EXPECT_NEAR(kernel(i, j) / kernel(0, 0), std::pow(decay, std::max(i, j)), 1e-6);
    }
  }
}

TEST(KernelPrior, IsNarrowerWhereTheResponseIsShorter) {
  const auto decay_of = [](double made) {
    const MatrixXd factor = kernel_factor(seen(12, 400, made, 0.5, 2), {{0, 12}});
    const MatrixXd kernel = (factor.transpose() * factor).inverse();
    return kernel(1, 1) / kernel(0, 0);
  };
  EXPECT_LT(decay_of(0.2), decay_of(0.8));
}

TEST(KernelPrior, LeavesColumnsOutsideOfBlocksFree) {
  const MatrixXd factor = kernel_factor(seen(8, 300, 0.6, 0.2, 3), {{0, 3}, {4, 4}});
  EXPECT_EQ(factor.row(3).norm(), 0);
  EXPECT_EQ(factor.col(3).norm(), 0);
  EXPECT_EQ(factor(2, 4), 0) << "channels know nothing of each other";
}

TEST(KernelPrior, TakesAChannelThatDoesNothing) {
  RegressionProducts none = seen(6, 200, 0.5, 1, 4);
  none.moment.setZero();
  EXPECT_TRUE(kernel_factor(none, {{0, 6}}).allFinite());
  none.gram.setZero();
  EXPECT_TRUE(kernel_factor(none, {{0, 6}}).allFinite());
}

// A step response without a choice of orders: 60 lags from 300 rows.
TEST(KernelPrior, FindsAStepResponseThatLeastSquaresLosesInNoise) {
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  Recording recording;
  recording.rate_hz = 10;
  recording.channels = {{"u", "", Role::kInput, {}}, {"y", "", Role::kOutput, {}}};
  double first = 0, second = 0;
  for (int t = 0; t < 300; ++t) {
    auto& u = recording.channels[0].samples;
    const double now = 1.6 * first - 0.65 * second + (t >= 3 ? 0.05 * u[std::size_t(t) - 3] : 0.0);
    second = std::exchange(first, now);
    u.push_back(normal(generator));
    recording.channels[1].samples.push_back(now + 0.2 * normal(generator));
  }
  std::vector<double> truth;
  double a = 0, b = 0;
  for (int t = 0; t < 60; ++t) {
    const double now = 1.6 * a - 0.65 * b + (t >= 3 ? 0.05 : 0.0);
    b = std::exchange(a, now);
    truth.push_back(now);
  }
  const auto error_with = [&](ArxKernel kernel) {
    ArxOptions options;
    options.orders = make_orders({.outputs = 1, .inputs = 1, .na = 0, .nb = 60, .nk = 0, .coupling = Coupling::kFull});
    options.kernel = kernel;
    const auto fit = fit_arx({&recording, 1}, {{"u"}, {"y"}}, options);
    EXPECT_TRUE(fit);
    const auto step = step_response(fit->model, 0, 0, 60).value;
    double square = 0;
    for (std::size_t t = 0; t < 60; ++t) square += std::pow(step[t] - truth[t], 2);
    return std::sqrt(square / 60);
  };
  EXPECT_LT(error_with(ArxKernel::kTc), 0.6 * error_with(ArxKernel::kNone));
  EXPECT_LT(error_with(ArxKernel::kTc), 0.15) << "of a gain of 1";
}

}  // namespace
}  // namespace wisp::arx::kernel_prior_test
