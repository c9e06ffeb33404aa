// Distances over two seconds: what half a second does not tell.

#include "learn/fidelity/fidelity_long.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace wisp::fidelity_long_test {
namespace {

constexpr LongOptions kOptions{.rate_hz = 60};

// Two channels of one resonance each; now and then one is hit.
Stretch resonances(std::size_t rows, std::uint64_t seed, double damping, double hit) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss;
  Stretch out{2, {}};
  double now[2] = {}, before[2] = {};
  for (std::size_t t = 0; t < rows; ++t) {
    for (int c = 0; c < 2; ++c) {
      double shock = gauss(random);
      if (hit > 0 && random() % 200 == 0) shock *= hit;
      const double next = 1.6 * now[c] - damping * before[c] + shock;
      before[c] = now[c];
      now[c] = next;
      out.values.push_back(next);
    }
  }
  return out;
}

LongDistances apart(const Stretch& a, const Stretch& b) { return long_distances({&a, 1}, {&b, 1}, kOptions); }

TEST(FidelityLong, TheSameProcessIsNear) {
  const LongDistances found = apart(resonances(6000, 1, 0.8, 0), resonances(6000, 2, 0.8, 0));
  EXPECT_LT(found.motion, 0.02);
  EXPECT_LT(found.spectra, 0.02);
  EXPECT_LT(found.tails, 0.1);
}

TEST(FidelityLong, SpectraTellAnotherRhythm) {
  const Stretch real = resonances(6000, 1, 0.8, 0);
  const double same = apart(real, resonances(6000, 2, 0.8, 0)).spectra;
  EXPECT_GT(apart(real, resonances(6000, 3, 0.9, 0)).spectra, 5 * same);
}

TEST(FidelityLong, TailsTellBurstsThatAreMissing) {
  const Stretch real = resonances(6000, 1, 0.8, 12);
  EXPECT_GT(apart(real, resonances(6000, 2, 0.8, 0)).tails, 0.3);
}

TEST(FidelityLong, TooFewWindowsAreNoDistance) {
  const LongDistances found = apart(resonances(100, 1, 0.8, 0), resonances(100, 2, 0.8, 0));
  EXPECT_TRUE(std::isnan(found.motion) && std::isnan(found.spectra) && std::isnan(found.tails));
}

TEST(FidelityLong, ASpectrumHasThePowerInItsBand) {
  Stretch wave{1, {}};
  for (int t = 0; t < 120; ++t) wave.values.push_back(std::sin(2 * 3.14159265358979 * 30 * t / 120));
  const FeatureWindows windows = spectral_windows({&wave, 1}, 120, 1);
  ASSERT_EQ(windows.size(), 1u);
  std::size_t loudest = 0;
  for (std::size_t f = 0; f < windows.features; ++f) {
    if (windows.values[f] > windows.values[loudest]) loudest = f;
  }
  // 30 of 60 frequencies lies in the last band but one, or the one before.
  EXPECT_GE(loudest + 4, windows.features);
  EXPECT_LT(loudest + 1, windows.features);
}

}  // namespace
}  // namespace wisp::fidelity_long_test
