// Whether standard errors mean what they say, over many simulated recordings.

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <random>

#include "learn/judge/judged_fit.hpp"
#include "learn/rows/arx_design.hpp"

namespace wisp::arx_statistics_test {
namespace {

// Coefficients of Π (1 − p q⁻¹) without the leading 1.
std::vector<double> polynomial(const std::vector<std::complex<double>>& poles) {
  std::vector<std::complex<double>> c{1};
  for (const auto& pole : poles) {
    c.push_back(0);
    for (std::size_t k = c.size() - 1; k > 0; --k) c[k] -= pole * c[k - 1];
  }
  std::vector<double> out;
  for (std::size_t k = 1; k < c.size(); ++k) out.push_back(c[k].real());
  return out;
}

// Two outputs, two inputs, different orders and delays in every entry, correlated noise.
struct System {
  ArxOrders orders;
  std::vector<std::vector<double>> theta;
};

System order_matrix_system() {
  using namespace std::complex_literals;
  const auto a11 = polynomial({.92 * std::exp(.35i), .92 * std::exp(-.35i), .55, -.4});
  const auto a22 = polynomial({.88 * std::exp(.9i), .88 * std::exp(-.9i), .3, .7});
  const auto matrix = [](int a, int b, int c, int d) {
    OrderMatrix out(2, 2);
    out(0, 0) = a, out(0, 1) = b, out(1, 0) = c, out(1, 1) = d;
    return out;
  };
  System system{{matrix(4, 2, 3, 4), matrix(4, 3, 2, 4), matrix(1, 3, 2, 0)}, {a11, {.07, -.05, .02}}};
  const auto append = [](std::vector<double>& row, std::vector<double> more) {
    row.insert(row.end(), more.begin(), more.end());
  };
  append(system.theta[0], {-.1, .06});
  append(system.theta[0], {.5, .25, -.1, .05});
  append(system.theta[0], {.3, -.2, .1});
  append(system.theta[1], a22);
  append(system.theta[1], {.4, .2});
  append(system.theta[1], {.15, -.3, .2, .1});
  return system;
}

Recording simulate(const System& system, std::size_t rows, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  Recording recording;
  recording.rate_hz = 1;
  for (const char* name : {"u1", "u2", "y1", "y2"}) {
    recording.channels.push_back({name, "", name[0] == 'u' ? Role::kInput : Role::kOutput, std::vector<double>(rows)});
  }
  ArxModel model;
  model.orders = system.orders;
  model.theta = system.theta;
  for (std::size_t t = 0; t < rows; ++t) {
    for (int k = 0; k < 2; ++k) recording.channels[k].samples[t] = normal(generator);
    const double first = normal(generator);
    const double second = normal(generator);
    const double noise[2] = {.2 * first, .06 * first + std::sqrt(.09 - .0036) * second};  // covariance .04, .012, .09
    for (int i = 0; i < 2; ++i) {
      double y = noise[i];
      for (int j = 0; j < 2; ++j) {
        const auto a = model.a(i, j);
        for (std::size_t l = 1; l <= a.size() && l <= t; ++l) y -= a[l - 1] * recording.channels[2 + j].samples[t - l];
        const auto b = model.b(i, j);
        const auto delay = static_cast<std::size_t>(system.orders.nk(i, j));
        for (std::size_t l = 0; l < b.size() && l + delay <= t; ++l) {
          y += b[l] * recording.channels[j].samples[t - l - delay];
        }
      }
      recording.channels[2 + i].samples[t] = y;
    }
  }
  return recording;
}

TEST(ArxStatistics, StandardErrorsCoverTheTruthAsOftenAsTheyShould) {
  const System system = order_matrix_system();
  ArxOptions options;
  options.orders = system.orders;
  options.judge_free_run = false;
  int coefficients = 0;
  int within[3] = {};
  double square = 0;
  for (unsigned run = 0; run < 100; ++run) {
    const Recording recording = simulate(system, 20000, 1000 + run);
    const auto fit = fit_arx({&recording, 1}, {{"u1", "u2"}, {"y1", "y2"}}, options);
    ASSERT_TRUE(fit) << fit.error().message;
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t p = 0; p < system.theta[i].size(); ++p) {
        const double score = std::abs(fit->model.theta[i][p] - system.theta[i][p]) / fit->model.std_error[i][p];
        ++coefficients;
        for (int k = 0; k < 3; ++k) within[k] += score < (k == 0 ? 1 : k == 1 ? 1.959964 : 3);
        square += score * score;
      }
    }
  }
  EXPECT_EQ(coefficients, 2600);
  // Shares of a standard normal, give or take 3.5 standard deviations of a share of 2600 (coefficients of one run are
  // correlated, so twice that): false alarm well below 1 in 1000, and the seeds are fixed.
  EXPECT_GE(within[2], 0.99 * coefficients);
  EXPECT_NEAR(within[1] / static_cast<double>(coefficients), 0.95, 0.03);
  EXPECT_NEAR(within[0] / static_cast<double>(coefficients), 0.6827, 0.064);
  EXPECT_NEAR(square / coefficients, 1, 0.2);
}

TEST(ArxStatistics, CovarianceTiesTheRowsTogether) {
  const System system = order_matrix_system();
  ArxOptions options;
  options.orders = system.orders;
  options.judge_free_run = false;
  options.covariance = true;
  double square = 0;
  double square_without_ties = 0;
  for (unsigned run = 0; run < 100; ++run) {
    const Recording recording = simulate(system, 5000, 3000 + run);
    const auto fit = fit_arx({&recording, 1}, {{"u1", "u2"}, {"y1", "y2"}}, options);
    ASSERT_TRUE(fit);
    ASSERT_EQ(fit->covariance.size(), 26u * 26u);
    // One combination over both rows: each row's gain from its own first lag and input.
    double sum = 0;
    double variance = 0;
    double own = 0;
    const std::size_t place[2] = {6, 20};  // u1's first lag in either row; their noise has correlation 0.2
    const std::size_t within[2] = {6, 7};
    for (int i = 0; i < 2; ++i) {
      sum += fit->model.theta[i][within[i]] - system.theta[i][within[i]];
      for (int j = 0; j < 2; ++j) variance += fit->covariance[place[i] * 26 + place[j]];
      own += fit->model.std_error[i][within[i]] * fit->model.std_error[i][within[i]];
      EXPECT_NEAR(fit->covariance[place[i] * 27] / std::pow(fit->model.std_error[i][within[i]], 2), 1, 1e-9);
    }
    square += sum * sum / variance / 100;
    square_without_ties += sum * sum / own / 100;
  }
  // A chi-squared variable of 100 degrees over 100: 1 ± 0.14, false alarm 1 in 2000 at 3.5 deviations.
  EXPECT_NEAR(square, 1, 0.5);
  EXPECT_NE(square, square_without_ties);
}

TEST(ArxStatistics, NoiseCovarianceIsThatOfTheNoise) {
  const System system = order_matrix_system();
  const Recording recording = simulate(system, 20000, 5);
  ArxOptions options;
  options.orders = system.orders;
  const auto fit = fit_arx({&recording, 1}, {{"u1", "u2"}, {"y1", "y2"}}, options);
  ASSERT_TRUE(fit);
  const auto& covariance = fit->summary.noise_covariance;
  EXPECT_NEAR(covariance[0], .04, .04 * 0.05);
  EXPECT_NEAR(covariance[1], .012, .06 * 0.05);
  EXPECT_EQ(covariance[1], covariance[2]);
  EXPECT_NEAR(covariance[3], .09, .09 * 0.05);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT(fit->model.noise.sd_ci95[i][0], fit->model.noise.sd[i]);
    EXPECT_GT(fit->model.noise.sd_ci95[i][1], fit->model.noise.sd[i]);
    EXPECT_NEAR(fit->model.noise.sd_ci95[i][1] / fit->model.noise.sd[i], 1 + 1.96 / std::sqrt(2 * 20000.), 1e-3);
  }
}

}  // namespace
}  // namespace wisp::arx_statistics_test
