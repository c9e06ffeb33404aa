#include "learn/numeric/spectrum.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "base/statistics.hpp"

namespace wisp {
namespace {

std::vector<double> hann(std::size_t length) {
  std::vector<double> window(length);
  for (std::size_t i = 0; i < length; ++i) {
    window[i] = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(length));
  }
  return window;
}

// Fourier sums by a table of cos and sin of 2π i / length: fast enough for segments of some hundred samples.
struct Fourier {
  explicit Fourier(std::size_t length) : length_(length), cosine_(length), sine_(length) {
    for (std::size_t i = 0; i < length; ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(length);
      cosine_[i] = std::cos(angle);
      sine_[i] = std::sin(angle);
    }
  }

  double squared_magnitude(std::span<const double> samples, std::size_t k) const {
    double real = 0;
    double imaginary = 0;
    for (std::size_t i = 0, at = 0; i < length_; ++i) {
      real += samples[i] * cosine_[at];
      imaginary -= samples[i] * sine_[at];
      at += k;  // i·k modulo the length; k is below the length
      if (at >= length_) at -= length_;
    }
    return real * real + imaginary * imaginary;
  }

 private:
  std::size_t length_;
  std::vector<double> cosine_;
  std::vector<double> sine_;
};

std::vector<double> without_mean(std::span<const double> samples) {
  const double mean = wisp::mean(samples);
  std::vector<double> out(samples.begin(), samples.end());
  for (double& value : out) value -= mean;
  return out;
}

}  // namespace

std::vector<double> joined(Samples stretches) {
  std::vector<double> out;
  for (const auto& stretch : stretches) out.insert(out.end(), stretch.begin(), stretch.end());
  return out;
}

std::vector<std::vector<double>> whole_stretches(std::span<const double> values) {
  std::vector<std::vector<double>> out;
  bool goes_on = false;
  for (const double value : values) {
    if (!std::isnan(value) && !goes_on) out.emplace_back();
    goes_on = !std::isnan(value);
    if (goes_on) out.back().push_back(value);
  }
  return out;
}

Spectrum welch(Samples stretches, double rate_hz, std::size_t length) {
  assert(length >= 2 && length % 2 == 0 && rate_hz > 0);
  const std::vector<double> window = hann(length);
  const Fourier fourier(length);
  const double energy = std::inner_product(window.begin(), window.end(), window.begin(), 0.0);
  Spectrum out;
  std::vector<double> sum(length / 2 + 1, 0.0);
  for (const auto& stretch : stretches) {
    for (std::size_t first = 0; first + length <= stretch.size(); first += length / 2) {
      std::vector<double> segment = without_mean(std::span(stretch).subspan(first, length));
      for (std::size_t i = 0; i < length; ++i) segment[i] *= window[i];
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += fourier.squared_magnitude(segment, k);
      ++out.segments;
    }
  }
  for (std::size_t k = 0; k < sum.size(); ++k) {
    out.frequency_hz.push_back(rate_hz * static_cast<double>(k) / static_cast<double>(length));
    if (out.segments == 0) continue;
    const double sides = k == 0 || k == length / 2 ? 1 : 2;
    out.power.push_back(sides * sum[k] / (rate_hz * energy * static_cast<double>(out.segments)));
  }
  return out;
}

CrossSpectrum cross_spectrum(std::span<const double> a, std::span<const double> b, double rate_hz, std::size_t length,
                             double frequency_hz) {
  const std::vector<double> window = hann(length);
  const auto amplitude = [&](std::span<const double> samples) {
    const std::vector<double> moved = without_mean(samples);
    std::complex<double> sum = 0;
    for (std::size_t k = 0; k < length; ++k) {
      sum += moved[k] * std::polar(window[k], -2 * std::numbers::pi * static_cast<double>(k) * frequency_hz / rate_hz);
    }
    return sum;
  };
  std::complex<double> cross = 0;
  double power_a = 0, power_b = 0;
  CrossSpectrum out;
  for (std::size_t first = 0; first + length <= std::min(a.size(), b.size()); first += length / 2) {
    const auto of_a = amplitude(a.subspan(first, length)), of_b = amplitude(b.subspan(first, length));
    if (std::isnan(of_a.real() + of_b.real())) continue;
    cross += of_a * std::conj(of_b);
    power_a += std::norm(of_a);
    power_b += std::norm(of_b);
    ++out.segments;
  }
  out.phase = std::arg(cross);
  out.coherence = std::norm(cross) / std::max(power_a * power_b, 1e-300);
  return out;
}

double log_spectral_distance(const Spectrum& p, const Spectrum& q) {
  assert(p.frequency_hz.size() == q.frequency_hz.size());
  if (p.power.empty() || q.power.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double peak =
      std::max(*std::max_element(p.power.begin(), p.power.end()), *std::max_element(q.power.begin(), q.power.end()));
  if (peak == 0) return 0;
  const double least = peak * 1e-10;
  double sum = 0;
  for (std::size_t k = 1; k < p.power.size(); ++k) {
    const double decibels = 10 * std::log10(std::max(p.power[k], least) / std::max(q.power[k], least));
    sum += decibels * decibels;
  }
  return std::sqrt(sum / static_cast<double>(p.power.size() - 1));
}

}  // namespace wisp
