// The bank against a plain implementation in double precision, written from the equation in model/arx.hpp.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <vector>

#include "model/sample_model.hpp"
#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/random.hpp"

namespace wisp::arx_reference_test {
namespace {

// What an input is made into, as model/model.hpp says.
std::vector<double> regressors_of(const Model& model, double input) {
  const InputShape shape = model.inputs[0].shape;
  if (!has_powers(shape)) return {input};
  const double size = std::abs(input), sign = input < 0 ? -1 : 1;
  return {size, std::sqrt(size), size * size, input, sign * std::sqrt(size), sign * size * size};
}

// y(t) + Σ A y(t−k) = Σ B u(t−k) + c + e(t) on deviations, history at the operating point.
class PlainArx {
 public:
  explicit PlainArx(const Model& model) : model_(model), arx_(std::get<ArxModel>(model.dynamics)) {
    const auto depth = static_cast<std::size_t>(arx_.orders.history() + 1);
    outputs_.assign(depth, std::vector<double>(arx_.orders.outputs(), 0.0));
    inputs_.assign(depth, std::vector<double>(arx_.orders.inputs(), 0.0));
  }

  // One step with an input already inside the trained range. Returns the outputs in their units.
  std::vector<double> step(double input, const std::vector<double>& noise) {
    push(inputs_, deviation(input));
    std::vector<double> now(arx_.orders.outputs());
    for (int i = 0; i < arx_.orders.outputs(); ++i) now[i] = arx_.constant[i] + noise[i] + products(i);
    push(outputs_, now);
    for (std::size_t i = 0; i < now.size(); ++i) now[i] += arx_.output_mean[i];
    return now;
  }

  // The largest of Σ|coefficient|·|what it multiplies| + |c| + |e| over the rows: what rounding is measured against.
  double sum_of_sizes(int i) const { return sizes_.empty() ? 0 : sizes_[i]; }

 private:
  static void push(std::deque<std::vector<double>>& history, std::vector<double> newest) {
    history.push_front(std::move(newest));
    history.pop_back();
  }

  std::vector<double> deviation(double input) const {
    std::vector<double> parts = regressors_of(model_, input);
    for (std::size_t k = 0; k < parts.size(); ++k) parts[k] -= arx_.input_mean[k];
    return parts;
  }

  double products(int i) {
    double sum = 0, sizes = std::abs(arx_.constant[i]);
    for (int j = 0; j < arx_.orders.outputs(); ++j) {
      int lag = 0;
      for (double a : arx_.a(i, j)) {
        const double product = -a * outputs_[lag++][j];
        sum += product;
        sizes += std::abs(product);
      }
    }
    for (int k = 0; k < arx_.orders.inputs(); ++k) {
      int lag = arx_.orders.nk(i, k);
      for (double b : arx_.b(i, k)) {
        const double product = b * inputs_[lag++][k];
        sum += product;
        sizes += std::abs(product);
      }
    }
    sizes_.resize(arx_.orders.outputs());
    sizes_[i] = std::max(sizes_[i], sizes);
    return sum;
  }

  const Model& model_;
  const ArxModel& arx_;
  std::deque<std::vector<double>> outputs_;  // newest first: outputs_[0] is lag 1 while a step is made
  std::deque<std::vector<double>> inputs_;   // newest first: inputs_[0] is lag 0
  std::vector<double> sizes_;
};

// e(t) of an instance of stream 0 in a bank of seed 1.
std::vector<double> noise_of(const Model& model, std::uint64_t step) {
  const auto& arx = std::get<ArxModel>(model.dynamics);
  const int ny = arx.orders.outputs();
  std::vector<double> shocks;
  for (std::uint32_t group = 0; shocks.size() < static_cast<std::size_t>(ny); ++group) {
    for (const std::uint32_t word : random_words({.seed = 1, .stream = 0, .step = step, .group = group})) {
      for (const float deviate : normal_pair(word)) shocks.push_back(deviate);
    }
  }
  std::vector<double> noise(ny);
  for (int i = 0; i < ny; ++i) noise[i] = arx.noise.sd[i] * shocks[i];
  return noise;
}

// How much an error made in every step, at most 1 in each row, grows: the largest row of Σ_k |H_k|, where H_k is the
// response of the outputs, k steps later, to a unit of e in each row.
double error_growth(const Model& model) {
  const auto& arx = std::get<ArxModel>(model.dynamics);
  const int ny = arx.orders.outputs();
  ArxModel bare = arx;
  std::fill(bare.constant.begin(), bare.constant.end(), 0.0);
  std::fill(bare.output_mean.begin(), bare.output_mean.end(), 0.0);
  std::fill(bare.input_mean.begin(), bare.input_mean.end(), 0.0);
  Model linear = model;
  linear.dynamics = bare;
  std::vector<double> rows(ny, 0.0);
  for (int shocked = 0; shocked < ny; ++shocked) {
    PlainArx system(linear);
    std::vector<double> noise(ny, 0.0);
    noise[shocked] = 1;
    for (int k = 0; k < 1000; ++k) {
      const std::vector<double> response = system.step(0, noise);
      for (int i = 0; i < ny; ++i) rows[i] += std::abs(response[i]);
      noise[shocked] = 0;
    }
  }
  return *std::max_element(rows.begin(), rows.end());
}

// The largest difference that rounding may make. A row of n terms, each a rounded coefficient times a rounded state,
// summed one by one, errs by at most (n + 3) u Σ|terms| with u = 2^-24 (Higham, Accuracy and Stability, section 3.1:
// n − 1 sums, a product and a coefficient; the noise adds a product and its deviate). Errors of all steps add up to at
// most error_growth times that. Reading rounds the mean, a product and a sum: 3 u of the largest output.
double rounding_bound(const Model& model, const PlainArx& plain, double largest_noise, double largest_output) {
  constexpr double kUnit = 0x1p-24;
  const auto& arx = std::get<ArxModel>(model.dynamics);
  double worst = 0;
  for (int i = 0; i < arx.orders.outputs(); ++i) {
    const int terms = arx.orders.row_size(i) + 2;
    worst = std::max(worst, (terms + 3) * kUnit * (plain.sum_of_sizes(i) + largest_noise));
  }
  return error_growth(model) * worst + 3 * kUnit * largest_output;
}

void expect_agreement(const Model& model) {
  auto bank = Bank::create(model, {});
  ASSERT_TRUE(bank) << bank.error().message;
  const InstanceId id = bank->spawn();
  PlainArx plain(model);
  double difference = 0, largest_noise = 0, largest_output = 0;
  std::vector<float> values(bank->output_count());
  for (std::uint64_t step = 0; step < 5000; ++step) {
    const auto phase = static_cast<float>(step % 64) / 64.0f;  // a saw, and rests
    const float input = step % 256 < 128 ? phase : 0.0f;
    ASSERT_TRUE(bank->set_inputs(id, std::span(&input, 1)));
    bank->step();
    ASSERT_TRUE(bank->outputs(id, values));
    const std::vector<double> noise = noise_of(model, step), expected = plain.step(input, noise);
    for (std::size_t i = 0; i < values.size(); ++i) {
      difference = std::max(difference, std::abs(values[i] - expected[i]));
      largest_noise = std::max(largest_noise, std::abs(noise[i]));
      largest_output = std::max(largest_output, std::abs(expected[i]));
    }
  }
  ASSERT_EQ(bank->clamped().clamped, 0U);
  const double bound = rounding_bound(model, plain, largest_noise, largest_output);
  std::printf("largest difference from double %.3g, bound by analysis %.3g\n", difference, bound);
  EXPECT_LT(difference, bound);
  EXPECT_LT(bound, 1e-3);
}

TEST(ArxReference, AFlameAgreesWithDoublePrecision) { expect_agreement(flame_model()); }

TEST(ArxReference, SoDoesOneWithPowersOfWind) { expect_agreement(flame_model({.wind = InputShape::kEvenOdd})); }

TEST(ArxReference, SoDoesAModelWithDelaysConstantsAndMixedOrders) { expect_agreement(sample_model()); }

// Units of a micrometre beside kilometres: deviations are scaled inside, so that agreement is relative to each range.
TEST(ArxReference, UnitsDoNotMatter) {
  Model model = flame_model();
  auto& arx = std::get<ArxModel>(model.dynamics);
  const double small = 0x1p-20;  // a power of two: scaled outputs must be the same bits
  for (int i = 0; i < 16; i += 2) {
    arx.output_mean[i] *= small;
    arx.noise.sd[i] *= small;
    model.outputs[i].lowest *= small;
    model.outputs[i].highest *= small;
    for (int k = 4; k < 12; ++k) arx.theta[i][k] *= small;     // others' outputs and wind into x
    for (int k = 0; k < 4; ++k) arx.theta[i + 1][k] /= small;  // x into y
  }
  auto plain = Bank::create(flame_model(), {}), scaled = Bank::create(model, {});
  ASSERT_TRUE(plain && scaled) << scaled.error().message;
  plain->spawn();
  scaled->spawn();
  std::vector<float> a(16), b(16);
  for (int step = 0; step < 100; ++step) {
    plain->step();
    scaled->step();
    plain->outputs(a);
    scaled->outputs(b);
    for (int i = 0; i < 16; ++i) ASSERT_EQ(a[i], b[i] / (i % 2 == 0 ? static_cast<float>(small) : 1.0f)) << i;
  }
}

// The last of all, so that as many shocks are resampled as if it had its own.
TEST(ArxReference, AnOutputWithoutNoiseStaysWithoutIt) {
  Model model = flame_model();
  std::get<ArxModel>(model.dynamics).noise.sd.back() = 0;
  expect_agreement(model);
}

// Orders so different that taps come in runs of every length, with delays and gaps of zeros between.
TEST(ArxReference, SparseAndRaggedModelsAgree) {
  Model model = sample_model();
  auto& arx = std::get<ArxModel>(model.dynamics);
  arx.theta.clear();
  for (int i = 0; i < 8; ++i) {
    std::vector<double> row;
    for (int j = 0; j < 8; ++j) {
      const int order = i == j ? 1 + (3 * i) % 11 : (i + j) % 3;
      arx.orders.na(i, j) = order;
      for (int lag = 0; lag < order; ++lag)
        row.push_back((lag + i) % 4 == 2 ? 0.0 : 0.03 / (1 + lag) * (j % 2 ? -1 : 1));
    }
    for (int k = 0; k < 6; ++k) {
      arx.orders.nb(i, k) = (i + k) % 6;
      arx.orders.nk(i, k) = (5 * i + k) % 9;
      for (int lag = 0; lag < arx.orders.nb(i, k); ++lag) row.push_back(0.05 * (lag + 1) - 0.1 * (i % 3));
    }
    arx.theta.push_back(row);
  }
  arx.std_error.clear();
  expect_agreement(model);
}

}  // namespace
}  // namespace wisp::arx_reference_test
