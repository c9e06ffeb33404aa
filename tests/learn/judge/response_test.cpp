#include "learn/judge/response.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "learn/rows/arx_design.hpp"

namespace wisp::response_test {
namespace {

using Complex = std::complex<double>;

ArxModel model_with(const ArxOrders& orders, std::vector<std::vector<double>> theta) {
  ArxModel model;
  model.orders = orders;
  model.theta = std::move(theta);
  model.constant.assign(model.theta.size(), 0.0);
  return model;
}

ArxModel first_order() {
  return model_with(make_orders({.outputs = 1, .inputs = 1, .na = 1, .nb = 1, .nk = 2}), {{-0.8, 0.5}});
}

// Two coupled outputs and two inputs with different delays.
ArxModel coupled() {
  ArxOrders orders = make_orders({.outputs = 2, .inputs = 2, .na = 2, .nb = 2, .nk = 1});
  orders.nk(0, 1) = 3;
  return model_with(orders, {{-1.2, 0.5, 0.2, -0.1, 1.0, 0.4, 0.3, -0.2}, {0.1, 0.05, -0.9, 0.3, -0.5, 0.2, 0.7, 0.6}});
}

// A positive definite matrix without structure.
std::vector<double> some_covariance(Eigen::Index size) {
  Eigen::MatrixXd root(size, size);
  for (Eigen::Index r = 0; r < size; ++r) {
    for (Eigen::Index c = 0; c < size; ++c) root(r, c) = 0.01 * std::sin(static_cast<double>(1 + r * size + c));
  }
  const Eigen::MatrixXd covariance = root * root.transpose();
  return {covariance.data(), covariance.data() + covariance.size()};
}

template <class Value>
double sd_by_differences(const ArxModel& model, std::span<const double> covariance, Value value) {
  constexpr double kStep = 1e-6;
  std::vector<double> slope;
  for (std::size_t i = 0; i < model.theta.size(); ++i) {
    for (std::size_t p = 0; p < model.theta[i].size(); ++p) {
      ArxModel up = model;
      ArxModel down = model;
      up.theta[i][p] += kStep;
      down.theta[i][p] -= kStep;
      slope.push_back((value(up) - value(down)) / (2 * kStep));
    }
  }
  const auto size = static_cast<Eigen::Index>(slope.size());
  const Eigen::Map<const Eigen::VectorXd> g(slope.data(), size);
  const Eigen::Map<const Eigen::MatrixXd> matrix(covariance.data(), size, size);
  return std::sqrt(g.dot(matrix * g));
}

TEST(Poles, AreTheRootsOfA) {
  const auto got = poles(model_with(make_orders({.outputs = 1, .na = 3}), {{-1.7, 1.0, -0.2}}));  // .5, .6 ± .2i
  ASSERT_EQ(got.size(), 3u);
  EXPECT_NEAR(std::abs(got[0] - Complex(0.6, 0.2)), 0, 1e-12);
  EXPECT_NEAR(std::abs(got[1] - Complex(0.6, -0.2)), 0, 1e-12);
  EXPECT_NEAR(std::abs(got[2] - 0.5), 0, 1e-12);
}

TEST(Zeros, AreTheRootsOfBForOneOutput) {
  const ArxModel model =
      model_with(make_orders({.outputs = 1, .inputs = 1, .na = 1, .nb = 3, .nk = 2}), {{-0.8, 2.0, -1.0, -1.5}});
  const auto got = zeros(model, 0, 0);  // 2z² − z − 1.5 = 2 (z − (1 ± √13)/4)
  ASSERT_EQ(got.size(), 2u);
  EXPECT_NEAR(std::abs(got[0] - (1 + std::sqrt(13.0)) / 4), 0, 1e-12);
  EXPECT_NEAR(std::abs(got[1] - (1 - std::sqrt(13.0)) / 4), 0, 1e-12);
}

TEST(Zeros, OfCoupledOutputsMakeTheTransferFunctionVanish) {
  const ArxModel model = coupled();
  for (int output = 0; output < 2; ++output) {
    for (int input = 0; input < 2; ++input) {
      const auto found = zeros(model, output, input);
      EXPECT_FALSE(found.empty());
      for (const Complex z : found) {
        const Complex x = 1.0 / z;
        Eigen::Matrix2cd a = Eigen::Matrix2cd::Identity();
        Eigen::Vector2cd b = Eigen::Vector2cd::Zero();
        for (int i = 0; i < 2; ++i) {
          for (int j = 0; j < 2; ++j) {
            for (int l = 0; l < 2; ++l) a(i, j) += model.a(i, j)[l] * std::pow(x, l + 1);
          }
          for (int l = 0; l < 2; ++l) b[i] += model.b(i, input)[l] * std::pow(x, model.orders.nk(i, input) + l);
        }
        EXPECT_LT(std::abs((a.inverse() * b)[output]), 1e-9 * b.norm());
      }
    }
  }
}

TEST(StepResponse, OfFirstOrderIsAnExponential) {
  const StepResponse got = step_response(first_order(), 0, 0, 10);
  for (int t = 0; t < 10; ++t) {
    EXPECT_NEAR(got.value[t], t < 2 ? 0 : 2.5 * (1 - std::pow(0.8, t - 1)), 1e-12) << t;
  }
  EXPECT_TRUE(got.sd.empty());
}

TEST(StepResponse, DeviationsAreThoseOfTheLinearisedResponse) {
  const ArxModel model = coupled();
  const auto covariance = some_covariance(16);
  for (int output = 0; output < 2; ++output) {
    const StepResponse got = step_response(model, output, 1, 12, covariance);
    for (int t = 0; t < 12; ++t) {
      const double want = sd_by_differences(
          model, covariance, [&](const ArxModel& other) { return step_response(other, output, 1, 12).value[t]; });
      EXPECT_NEAR(got.sd[t], want, 1e-7) << t;
    }
  }
}

TEST(FrequencyResponse, OfFirstOrderIsKnown) {
  const std::vector<double> omega{0.0, 0.3, std::numbers::pi};
  const FrequencyResponse got = frequency_response(first_order(), 0, 0, omega);
  for (std::size_t k = 0; k < omega.size(); ++k) {
    const Complex x = std::polar(1.0, -omega[k]);
    EXPECT_NEAR(std::abs(got.value[k] - 0.5 * x * x / (1.0 - 0.8 * x)), 0, 1e-13);
  }
}

TEST(FrequencyResponse, DeviationsAreThoseOfTheLinearisedResponse) {
  const ArxModel model = coupled();
  const auto covariance = some_covariance(16);
  for (double w : {0.1, 1.0, 2.5}) {
    const FrequencyResponse got = frequency_response(model, 1, 0, {&w, 1}, covariance);
    const auto at = [&](const ArxModel& other) { return frequency_response(other, 1, 0, {&w, 1}).value[0]; };
    EXPECT_NEAR(got.amplitude_sd[0],
                sd_by_differences(model, covariance, [&](const ArxModel& other) { return std::abs(at(other)); }), 1e-7);
    EXPECT_NEAR(got.phase_sd[0],
                sd_by_differences(model, covariance, [&](const ArxModel& other) { return std::arg(at(other)); }), 1e-7);
  }
}

}  // namespace
}  // namespace wisp::response_test
