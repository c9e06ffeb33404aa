#include "sound/wind_filters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

namespace wisp::wind::wind_filters_test {
namespace {

/// RMS gain of a filter at a frequency, measured on one second of a sine after 0.5 s.
template <class Pass>
double gain_at(double frequency_hz, double rate_hz, Pass pass) {
  double in = 0;
  double out = 0;
  const int n = static_cast<int>(1.5 * rate_hz);
  for (int i = 0; i < n; ++i) {
    const double x = std::sin(2 * std::numbers::pi * frequency_hz * i / rate_hz);
    const double y = static_cast<double>(pass(static_cast<float>(x)));
    if (3 * i < n) continue;
    in += x * x;
    out += y * y;
  }
  return std::sqrt(out / in);
}

TEST(WindFilters, HighPassIsThreeDecibelsDownAtItsFrequency) {
  const Section s = high_pass(80, std::numbers::sqrt2 / 2, 8000);
  Filter<float> filter(s);
  const auto gain = [&](double hz) { return s.gain * gain_at(hz, 8000, [&](float x) { return filter.high(x); }); };
  EXPECT_NEAR(gain(80), std::numbers::sqrt2 / 2, 1e-3);
  EXPECT_NEAR(gain(1000), 1, 1e-2);
  EXPECT_NEAR(gain(8), 0.01, 1e-3);
}

TEST(WindFilters, LowPassIsThreeDecibelsDownAtItsFrequency) {
  const Section s = low_pass(900, std::numbers::sqrt2 / 2, 8000);
  Filter<float> filter(s);
  const auto gain = [&](double hz) { return s.gain * gain_at(hz, 8000, [&](float x) { return filter.low(x); }); };
  EXPECT_NEAR(gain(900), std::numbers::sqrt2 / 2, 1e-3);
  EXPECT_NEAR(gain(50), 1, 1e-2);
  EXPECT_LT(gain(3600), 0.02);
}

TEST(WindFilters, BandPassIsOneInItsMiddleAndThreeDecibelsDownAtItsEdges) {
  const double q = 2;
  const Section s = band_pass(500, q, 8000);
  Filter<float> filter(s);
  const auto gain = [&](double hz) { return s.gain * gain_at(hz, 8000, [&](float x) { return filter.band(x); }); };
  EXPECT_NEAR(gain(500), 1, 1e-3);
  const double edge = 500 * (std::sqrt(1 + 1 / (4 * q * q)) + 1 / (2 * q));
  EXPECT_NEAR(gain(edge), std::numbers::sqrt2 / 2, 0.02);  // the bilinear transform bends the upper edge a little
}

TEST(WindFilters, CoefficientsAreThoseOfTheCLibrarysFunctions) {
  for (const double hz : {20.0, 126.5, 900.0, 2646.0, 3900.0}) {
    const Section s = high_pass(hz, 0.707, 8000);
    const double w = 2 * std::numbers::pi * hz / 8000;
    const double alpha = std::sin(w) / 1.414;
    EXPECT_NEAR(s.a1, -2 * std::cos(w) / (1 + alpha), 2e-7);
    EXPECT_NEAR(s.a2, (1 - alpha) / (1 + alpha), 2e-7);
    EXPECT_NEAR(s.gain, (1 + std::cos(w)) / 2 / (1 + alpha), 1e-13);
  }
}

TEST(WindFilters, WindowedSincPassesWhatIsBelowItsEdge) {
  const std::vector<float> taps = windowed_sinc(30, 3800.0 / 48000);
  EXPECT_NEAR(std::accumulate(taps.begin(), taps.end(), 0.0), 1, 1e-6);
  const auto gain = [&](double hz) {
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < taps.size(); ++i) {
      sum +=
          static_cast<double>(taps[i]) * std::polar(1.0, -2 * std::numbers::pi * hz / 48000 * static_cast<double>(i));
    }
    return std::abs(sum);
  };
  EXPECT_GT(gain(900), 0.97);
  EXPECT_LT(gain(8000), 0.01);  // folds onto 0 Hz
  for (std::size_t i = 0; i < taps.size() / 2; ++i) EXPECT_FLOAT_EQ(taps[i], taps[taps.size() - 1 - i]);
}

TEST(WindFilters, ApproachIsAnExponential) {
  for (const double x : {1e-6, 1e-3, 0.1, 1.0, 7.0, 29.0}) EXPECT_NEAR(approach(x, 1), -std::expm1(-x), 1e-13);
  EXPECT_EQ(approach(1, 0), 1);
  EXPECT_EQ(approach(100, 1), 1);
}

TEST(WindFilters, SilenceLeavesNothingInAFilter) {
  Filter<float> filter(band_pass(126.5, 1.054, 8000));
  filter.band(1);
  for (int i = 0; i < 8000; ++i) {
    filter.band(0);
    if (i % 80 == 0) filter.hush();
  }
  EXPECT_EQ(filter.band(0), 0.0F);
}

}  // namespace
}  // namespace wisp::wind::wind_filters_test
