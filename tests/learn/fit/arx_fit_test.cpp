#include "learn/fit/arx_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "learn/judge/judged_fit.hpp"
#include "learn/rows/arx_design.hpp"

namespace wisp::arx_fit_test {
namespace {

// y(t) = 1.5 y(t−1) − 0.7 y(t−2) + u(t−1) + 0.5 u(t−2), without noise, about an operating point.
Recording second_order(std::size_t rows) {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  Recording recording;
  recording.source = "second_order";
  recording.rate_hz = 10;
  std::vector<double> u(rows), y(rows);
  for (std::size_t t = 0; t < rows; ++t) {
    u[t] = normal(generator);
    if (t >= 2) y[t] = 1.5 * y[t - 1] - 0.7 * y[t - 2] + u[t - 1] + 0.5 * u[t - 2];
  }
  recording.channels = {{"u", "", Role::kInput, u}, {"y", "", Role::kOutput, y}};
  return recording;
}

TEST(ArxFit, FindsTheCoefficientsOfNoiselessData) {
  const Recording recording = second_order(200);
  ArxOptions options;
  options.orders = make_orders({.outputs = 1, .inputs = 1, .na = 2, .nb = 2, .nk = 1});
  options.offset = ArxOffset::kNone;
  const auto fit = fit_arx({&recording, 1}, {{"u"}, {"y"}}, options);
  ASSERT_TRUE(fit) << fit.error().message;
  const std::vector<double> expected{-1.5, 0.7, 1.0, 0.5};
  for (std::size_t p = 0; p < 4; ++p) EXPECT_NEAR(fit->model.theta[0][p], expected[p], 1e-12);
  EXPECT_EQ(fit->summary.rows, 198u);
  EXPECT_EQ(fit->summary.first_sample, 2);
  EXPECT_TRUE(fit->summary.usable.verdict);
  EXPECT_NEAR(fit->summary.stable.radius, std::sqrt(0.7), 1e-6);
  EXPECT_TRUE(check(fit->model));
}

}  // namespace
}  // namespace wisp::arx_fit_test
