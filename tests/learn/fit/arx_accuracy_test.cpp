// Ill-conditioned data against least squares in 60 decimal digits.

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "learn/judge/judged_fit.hpp"
#include "learn/rows/arx_design.hpp"

namespace wisp::arx_accuracy_test {
namespace {

using Wide = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<60>>;

struct ExactFit {
  std::vector<double> theta;
  std::vector<double> std_error;
  double loss = 0;
};

// Gauss–Jordan elimination with pivots on the diagonal: the matrix is positive definite.
void invert(std::vector<std::vector<Wide>>& matrix) {
  const std::size_t n = matrix.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Wide pivot = 1 / matrix[k][k];
    for (Wide& entry : matrix[k]) entry *= pivot;
    matrix[k][k] = pivot;
    for (std::size_t r = 0; r < n; ++r) {
      if (r == k) continue;
      const Wide factor = matrix[r][k];
      matrix[r][k] = 0;
      for (std::size_t c = 0; c < n; ++c) matrix[r][c] -= factor * matrix[k][c];
    }
  }
}

std::vector<Wide> deviations(const std::vector<double>& samples) {
  Wide sum = 0;
  for (double sample : samples) sum += sample;
  std::vector<Wide> out;
  for (double sample : samples) out.push_back(sample - sum / samples.size());
  return out;
}

// Normal equations in 60 digits: a condition of 1e7 leaves 46 of them. Channels are inputs but the last, the output;
// the same orders for all inputs.
ExactFit exact_fit(const Recording& recording, std::size_t na, std::size_t nb, std::size_t nk) {
  std::vector<std::vector<Wide>> series;
  for (const Channel& channel : recording.channels) series.push_back(deviations(channel.samples));
  const std::vector<Wide> y = series.back();
  series.pop_back();
  const std::size_t d = na + nb * series.size();
  std::vector<std::vector<Wide>> gram(d, std::vector<Wide>(d));
  std::vector<Wide> moment(d), x(d);
  Wide square = 0;
  const std::size_t first = std::max(na, nb + nk - 1);
  for (std::size_t t = first; t < y.size(); ++t) {
    std::size_t p = 0;
    for (std::size_t l = 1; l <= na; ++l) x[p++] = -y[t - l];
    for (const std::vector<Wide>& u : series) {
      for (std::size_t l = 0; l < nb; ++l) x[p++] = u[t - nk - l];
    }
    for (p = 0; p < d; ++p) {
      moment[p] += x[p] * y[t];
      for (std::size_t q = 0; q <= p; ++q) gram[p][q] += x[p] * x[q];
    }
    square += y[t] * y[t];
  }
  for (std::size_t p = 0; p < d; ++p) {
    for (std::size_t q = 0; q < p; ++q) gram[q][p] = gram[p][q];
  }
  invert(gram);
  ExactFit fit;
  const double n = static_cast<double>(y.size() - first);
  for (std::size_t p = 0; p < d; ++p) {
    Wide theta = 0;
    for (std::size_t q = 0; q < d; ++q) theta += gram[p][q] * moment[q];
    fit.theta.push_back(static_cast<double>(theta));
    square -= theta * moment[p];
  }
  fit.loss = static_cast<double>(square) / n;
  for (std::size_t p = 0; p < d; ++p) {
    fit.std_error.push_back(std::sqrt(static_cast<double>(gram[p][p]) * fit.loss * n / (n - static_cast<double>(d))));
  }
  return fit;
}

// A slow system that is sampled far too fast, driven by a smooth input: neighbouring samples are nearly the same. The
// poles 1 − slowness · (1, 1.5, 2) and a little noise on the output.
Recording oversampled(double slowness, double noise, std::size_t rows) {
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal;
  std::vector<double> u(rows), y(rows);
  const double p[3] = {1 - slowness, 1 - 1.5 * slowness, 1 - 2 * slowness};
  const double a1 = -(p[0] + p[1] + p[2]);
  const double a2 = p[0] * p[1] + p[0] * p[2] + p[1] * p[2];
  const double a3 = -p[0] * p[1] * p[2];
  double drive = 0;
  const double gain = slowness * slowness * slowness;
  for (std::size_t t = 0; t < rows; ++t) {
    drive = 0.9 * drive + normal(generator);
    u[t] = 5 + drive;
    if (t >= 3)
      y[t] = -a1 * y[t - 1] - a2 * y[t - 2] - a3 * y[t - 3] + gain * (u[t - 1] - 5) + noise * gain * normal(generator);
  }
  for (double& sample : y) sample += 20;
  Recording recording;
  recording.rate_hz = 1000;
  recording.channels = {{"u", "", Role::kInput, u}, {"y", "", Role::kOutput, y}};
  return recording;
}

double relative_difference(const std::vector<double>& got, const std::vector<double>& want) {
  double difference = 0;
  double largest = 0;
  for (std::size_t k = 0; k < want.size(); ++k) {
    difference = std::max(difference, std::abs(got[k] - want[k]));
    largest = std::max(largest, std::abs(want[k]));
  }
  return difference / largest;
}

// Two inputs that differ by `difference` of their size, and ordinary noise.
Recording nearly_the_same_inputs(double difference, std::size_t rows) {
  std::mt19937_64 generator(11);
  std::normal_distribution<double> normal;
  std::vector<double> u1(rows), u2(rows), y(rows);
  for (std::size_t t = 0; t < rows; ++t) {
    u1[t] = 1 + normal(generator);
    u2[t] = u1[t] + difference * normal(generator);
    if (t >= 1) y[t] = 0.8 * y[t - 1] + u1[t - 1] + 0.5 * u2[t - 1] + 0.1 * normal(generator);
  }
  Recording recording;
  recording.rate_hz = 100;
  recording.channels = {{"u1", "", Role::kInput, u1}, {"u2", "", Role::kInput, u2}, {"y", "", Role::kOutput, y}};
  return recording;
}

struct Comparison {
  ArxSummary summary;
  double theta = 0;
  double std_error = 0;
  double loss = 0;
};

Comparison compare(const Recording& recording, int na, int nb) {
  ChannelChoice channels;
  for (const Channel& channel : recording.channels) {
    (channel.role == Role::kInput ? channels.inputs : channels.outputs).push_back(channel.name);
  }
  ArxOptions options;
  options.orders =
      make_orders({.outputs = 1, .inputs = static_cast<int>(channels.inputs.size()), .na = na, .nb = nb, .nk = 1});
  options.stabilise = false;
  const auto fit = fit_arx({&recording, 1}, channels, options);
  if (!fit) throw std::runtime_error(fit.error().message);
  const ExactFit exact = exact_fit(recording, static_cast<std::size_t>(na), static_cast<std::size_t>(nb), 1);
  return {fit->summary, relative_difference(fit->model.theta[0], exact.theta),
          relative_difference(fit->model.std_error[0], exact.std_error),
          std::abs(fit->summary.loss[0] / exact.loss - 1)};
}

bool by_qr(const ArxSummary& summary) { return summary.method.find("QR") != std::string::npos; }

TEST(ArxAccuracy, NormalEquationsAreRefinedToTheAccuracyOfQr) {
  const Comparison got = compare(nearly_the_same_inputs(2e-3, 3000), 1, 1);
  EXPECT_GT(got.summary.condition[0], 1e3);
  EXPECT_FALSE(by_qr(got.summary)) << got.summary.method;
  // 2.2e-16 times the condition, and some for the residual's part; unrefined they are near 1e-10.
  EXPECT_LT(got.theta, 2e-12);
  EXPECT_LT(got.std_error, 1e-9);
  EXPECT_LT(got.loss, 1e-13);
}

TEST(ArxAccuracy, ConditionOfAMillionFromAnOversampledSystemCostsFewDigits) {
  const Comparison got = compare(oversampled(0.006, 0.1, 5000), 3, 2);
  EXPECT_GT(got.summary.condition[0], 1e6);
  EXPECT_TRUE(by_qr(got.summary)) << got.summary.method;
  EXPECT_LT(got.theta, 1e-7);
  EXPECT_LT(got.std_error, 1e-7);
  EXPECT_LT(got.loss, 1e-7);
}

TEST(ArxAccuracy, ConditionOfTenMillionFromNearlyTheSameInputsCostsFewDigits) {
  const Comparison got = compare(nearly_the_same_inputs(3e-7, 3000), 1, 1);
  EXPECT_GT(got.summary.condition[0], 1e7);
  EXPECT_TRUE(by_qr(got.summary)) << got.summary.method;
  EXPECT_TRUE(got.summary.rank_problems.empty());
  EXPECT_LT(got.theta, 1e-7);
  EXPECT_LT(got.std_error, 1e-7);
  EXPECT_LT(got.loss, 1e-7);
}

TEST(ArxAccuracy, ConditionOfTenMillionFromAnOversampledSystemCostsFewDigits) {
  const Comparison got = compare(oversampled(0.0021, 0.1, 5000), 3, 2);
  EXPECT_GT(got.summary.condition[0], 1e7);
  EXPECT_LT(got.theta, 1e-7);
  EXPECT_LT(got.std_error, 1e-7);
  EXPECT_LT(got.loss, 1e-7);
}

}  // namespace
}  // namespace wisp::arx_accuracy_test
