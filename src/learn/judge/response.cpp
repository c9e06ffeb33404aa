#include "learn/judge/response.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

#include "learn/fit/arx_errors.hpp"
#include "learn/fit/arx_report.hpp"
#include "learn/numeric/decompositions.hpp"

namespace wisp {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using Complex = std::complex<double>;

// A(q) evaluated at q⁻¹ = x.
MatrixXcd a_at(const ArxModel& model, Complex x) {
  const int ny = model.orders.outputs();
  MatrixXcd value = MatrixXcd::Identity(ny, ny);
  for (int i = 0; i < ny; ++i) {
    for (int j = 0; j < ny; ++j) {
      Complex power = x;
      for (double a : model.a(i, j)) value(i, j) += a * power, power *= x;
    }
  }
  return value;
}

VectorXcd b_at(const ArxModel& model, int input, Complex x) {
  VectorXcd value = VectorXcd::Zero(model.orders.outputs());
  for (int i = 0; i < model.orders.outputs(); ++i) {
    Complex power = std::pow(x, model.orders.nk(i, input));
    for (double b : model.b(i, input)) value[i] += b * power, power *= x;
  }
  return value;
}

int degree_of_a(const ArxModel& model) {
  int degree = 0;
  for (int i = 0; i < model.orders.outputs(); ++i) {
    int longest = 0;
    for (int j = 0; j < model.orders.outputs(); ++j) longest = std::max(longest, model.orders.na(i, j));
    degree += longest;
  }
  return degree;
}

// Coefficients of the numerator det[A with column `output` replaced by B's column `input`] in x = q⁻¹, found from its
// values on the unit circle.
std::vector<double> numerator(const ArxModel& model, int output, int input) {
  int longest = 0;
  for (int i = 0; i < model.orders.outputs(); ++i) {
    longest = std::max(longest, model.orders.nk(i, input) + model.orders.nb(i, input));
  }
  const int count = degree_of_a(model) + longest + 1;
  std::vector<Complex> values;
  for (int k = 0; k < count; ++k) {
    const Complex x = std::polar(1.0, 2 * std::numbers::pi * k / count);
    MatrixXcd matrix = a_at(model, x);
    matrix.col(output) = b_at(model, input, x);
    values.push_back(matrix.determinant());
  }
  std::vector<double> coefficients;
  for (int degree = 0; degree < count; ++degree) {
    Complex sum = 0;
    for (int k = 0; k < count; ++k) {
      sum += values[k] * std::polar(1.0, -2 * std::numbers::pi *
                                             static_cast<double>((static_cast<long>(degree) * k) % count) / count);
    }
    coefficients.push_back(sum.real() / count);
  }
  return coefficients;
}

// Removes leading and trailing coefficients that are zero up to rounding.
void trim(std::vector<double>& polynomial) {
  double largest = 0;
  for (double c : polynomial) largest = std::max(largest, std::abs(c));
  const auto matters = [&](double c) { return std::abs(c) > 1e-12 * largest; };
  polynomial.erase(polynomial.begin(), std::find_if(polynomial.begin(), polynomial.end(), matters));
  while (!polynomial.empty() && !matters(polynomial.back())) polynomial.pop_back();
}

std::vector<Complex> sorted(const VectorXcd& values) {
  std::vector<Complex> out(values.begin(), values.end());
  std::sort(out.begin(), out.end(), [](Complex a, Complex b) {
    const double apart = std::abs(a) - std::abs(b);
    if (std::abs(apart) > 1e-12 * (std::abs(a) + std::abs(b))) return apart > 0;
    return a.real() != b.real() ? a.real() > b.real() : a.imag() > b.imag();
  });
  return out;
}

using Covariance = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

Covariance as_matrix(std::span<const double> covariance, Index size) {
  assert(covariance.size() == static_cast<std::size_t>(size * size));
  return {covariance.data(), size, size};
}

// Impulse response of all outputs to one input: samples × outputs.
MatrixXd impulse(const ArxModel& model, int input, int samples) {
  const int ny = model.orders.outputs();
  MatrixXd response = MatrixXd::Zero(samples, ny);
  for (int t = 0; t < samples; ++t) {
    for (int i = 0; i < ny; ++i) {
      double value = 0;
      const auto b = model.b(i, input);
      const int lag = t - model.orders.nk(i, input);
      if (lag >= 0 && lag < static_cast<int>(b.size())) value = b[lag];
      for (int j = 0; j < ny; ++j) {
        const auto a = model.a(i, j);
        for (int l = 1; l <= std::min(t, static_cast<int>(a.size())); ++l) value -= a[l - 1] * response(t - l, j);
      }
      response(t, i) = value;
    }
  }
  return response;
}

MatrixXd cumulated(MatrixXd series) {
  for (Index t = 1; t < series.rows(); ++t) series.row(t) += series.row(t - 1);
  return series;
}

VectorXd convolved(const VectorXd& a, const VectorXd& b) {
  VectorXd out = VectorXd::Zero(a.size());
  for (Index t = 0; t < a.size(); ++t) out.tail(a.size() - t) += a[t] * b.head(a.size() - t);
  return out;
}

VectorXd delayed(const VectorXd& series, Index samples) {
  VectorXd out = VectorXd::Zero(series.size());
  if (samples < series.size()) out.tail(series.size() - samples) = series.head(series.size() - samples);
  return out;
}

// Gradient of the step response in the coefficients, samples × d_total: for A, −(step response of the multiplied
// output); for B of this input, the unit step; both delayed by the lag and filtered by the noise response.
MatrixXd step_slopes(const ArxModel& model, int output, int input, const MatrixXd& step) {
  const int ny = model.orders.outputs();
  const Index samples = step.rows();
  const auto starts = row_starts(model);
  const auto shocks = noise_response(model, static_cast<int>(samples));
  const VectorXd ones = VectorXd::Ones(samples);
  MatrixXd slopes = MatrixXd::Zero(samples, starts.back());
  for (int i = 0; i < ny; ++i) {
    VectorXd through(samples);
    for (Index t = 0; t < samples; ++t) through[t] = shocks[t](output, i);
    Index at = starts[i];
    for (int j = 0; j < ny; ++j) {
      if (model.orders.na(i, j) == 0) continue;
      const VectorXd passed = convolved(through, step.col(j));
      for (int l = 1; l <= model.orders.na(i, j); ++l) slopes.col(at++) = -delayed(passed, l);
    }
    for (int k = 0; k < model.orders.inputs(); ++k) {
      const VectorXd passed = k == input ? convolved(through, ones) : VectorXd::Zero(samples).eval();
      for (int l = 0; l < model.orders.nb(i, k); ++l) slopes.col(at++) = delayed(passed, model.orders.nk(i, k) + l);
    }
  }
  return slopes;
}

// ∂G/∂θ at x = e^{−iω}: ∂(A⁻¹B) = A⁻¹(∂B − ∂A G).
VectorXcd frequency_slopes(const ArxModel& model, int output, int input, Complex x, const MatrixXcd& inverse,
                           const VectorXcd& g) {
  const auto starts = row_starts(model);
  VectorXcd slopes = VectorXcd::Zero(starts.back());
  for (int i = 0; i < model.orders.outputs(); ++i) {
    Index at = starts[i];
    for (int j = 0; j < model.orders.outputs(); ++j) {
      Complex power = x;
      for (int l = 1; l <= model.orders.na(i, j); ++l, power *= x) slopes[at++] = -inverse(output, i) * power * g[j];
    }
    for (int k = 0; k < model.orders.inputs(); ++k) {
      Complex power = std::pow(x, model.orders.nk(i, k));
      for (int l = 0; l < model.orders.nb(i, k); ++l, power *= x) {
        slopes[at++] = k == input ? inverse(output, i) * power : Complex(0);
      }
    }
  }
  return slopes;
}

}  // namespace

std::vector<std::complex<double>> poles(const ArxModel& model) {
  std::vector<int> outputs(std::size_t(model.orders.outputs()));
  std::iota(outputs.begin(), outputs.end(), 0);
  const MatrixXd companion = companion_of(model, outputs);
  if (companion.size() == 0) return {};
  auto all = sorted(eigenvalues(companion));
  all.resize(std::min<std::size_t>(all.size(), static_cast<std::size_t>(degree_of_a(model))));
  return all;
}

std::vector<std::complex<double>> zeros(const ArxModel& model, int output, int input) {
  assert(output >= 0 && output < model.orders.outputs() && input >= 0 && input < model.orders.inputs());
  std::vector<double> polynomial = numerator(model, output, input);
  trim(polynomial);
  if (polynomial.size() < 2) return {};
  const auto degree = static_cast<Index>(polynomial.size()) - 1;
  MatrixXd companion = MatrixXd::Zero(degree, degree);
  for (Index k = 0; k < degree; ++k) companion(0, k) = -polynomial[k + 1] / polynomial[0];
  for (Index r = 1; r < degree; ++r) companion(r, r - 1) = 1;
  return sorted(eigenvalues(companion));
}

StepResponse step_response(const ArxModel& model, int output, int input, int samples,
                           std::span<const double> covariance) {
  assert(output >= 0 && output < model.orders.outputs() && input >= 0 && input < model.orders.inputs());
  const MatrixXd step = cumulated(impulse(model, input, samples));
  StepResponse response;
  for (Index t = 0; t < step.rows(); ++t) response.value.push_back(step(t, output));
  if (covariance.empty()) return response;
  const MatrixXd slopes = step_slopes(model, output, input, step);
  const auto matrix = as_matrix(covariance, slopes.cols());
  for (Index t = 0; t < step.rows(); ++t) {
    response.sd.push_back(std::sqrt(std::max(0.0, slopes.row(t).dot(slopes.row(t) * matrix))));
  }
  return response;
}

FrequencyResponse frequency_response(const ArxModel& model, int output, int input, std::span<const double> omega,
                                     std::span<const double> covariance) {
  assert(output >= 0 && output < model.orders.outputs() && input >= 0 && input < model.orders.inputs());
  FrequencyResponse response;
  for (double w : omega) {
    const Complex x = std::polar(1.0, -w);
    const MatrixXcd inverse = complex_inverse(a_at(model, x));
    const VectorXcd g = inverse * b_at(model, input, x);
    response.value.push_back(g[output]);
    if (covariance.empty()) continue;
    const VectorXcd slopes = frequency_slopes(model, output, input, x, inverse, g);
    const auto matrix = as_matrix(covariance, slopes.size());
    const VectorXcd turned = std::conj(g[output]) / std::abs(g[output]) * slopes;  // parallel and perpendicular to G
    const VectorXd along = turned.real();
    const VectorXd across = turned.imag() / std::abs(g[output]);
    response.amplitude_sd.push_back(std::sqrt(std::max(0.0, along.dot(matrix * along))));
    response.phase_sd.push_back(std::sqrt(std::max(0.0, across.dot(matrix * across))));
  }
  return response;
}

}  // namespace wisp
