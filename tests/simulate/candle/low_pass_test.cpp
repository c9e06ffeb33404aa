#include "simulate/candle/wind_signal.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace wisp::flow::low_pass_test {
namespace {

double gain_at(double frequency_hz) {
  LowPass filter(300, 44100);
  const double step = 2 * 3.14159265358979323846 * frequency_hz / 44100;
  double most = 0;
  for (int k = 0; k < 44100; ++k) {
    const double y = filter.next(std::sin(step * k));
    if (k > 22050) most = std::max(most, std::abs(y));
  }
  return most;
}

TEST(LowPass, IsFlatBelowItsCornerAndFallsByTwelveDecibelsAnOctaveAbove) {
  const double flat = gain_at(30);
  EXPECT_NEAR(20 * std::log10(gain_at(100) / flat), 0, 0.2);
  EXPECT_NEAR(20 * std::log10(gain_at(300) / flat), -3.01, 0.1);
  EXPECT_NEAR(20 * std::log10(gain_at(4800) / gain_at(2400)), -12, 0.6);
}

TEST(LowPass, KeepsThePowerOfWhiteNoise) {
  LowPass filter(6, 240);
  double energy = 0;
  for (int k = 0; k < 20000; ++k) {
    const double y = filter.next(k == 0 ? 1 : 0);
    energy += y * y;
  }
  EXPECT_NEAR(energy, 1, 1e-9);
}

}  // namespace
}  // namespace wisp::flow::low_pass_test
