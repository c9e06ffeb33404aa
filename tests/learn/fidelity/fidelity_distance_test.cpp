#include "learn/fidelity/fidelity_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "learn/numeric/made_series.hpp"

namespace wisp::fidelity_distance_test {
namespace {

Stretch interleaved(const std::vector<double>& a, const std::vector<double>& b, std::size_t first, std::size_t last) {
  Stretch out{2, {}};
  for (std::size_t t = first; t < last; ++t) {
    out.values.push_back(a[t]);
    out.values.push_back(b[t]);
  }
  return out;
}

FeatureWindows normal_windows(std::size_t windows, double mean, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss(mean, 1);
  FeatureWindows out{3, {}};
  for (std::size_t i = 0; i < windows; ++i) {
    for (int f = 0; f < 3; ++f) out.values.push_back(gauss(random));
  }
  return out;
}

TEST(FidelityEnergy, DistanceAgreesWithNumpy) {
  const auto x = made::first_series();
  const auto y = made::second_series();
  FeatureWindows real = motion_windows(std::vector{interleaved(x, y, 0, 100)}, 5, 3);
  FeatureWindows other = motion_windows(std::vector{interleaved(y, x, 100, 180)}, 5, 3);
  ASSERT_EQ(real.size(), 32u);
  ASSERT_EQ(other.size(), 25u);
  ASSERT_EQ(real.features, 20u);
  standardise(real, other);
  EXPECT_NEAR(energy_distance(real, other), 0.01459077752966608, 1e-12);
}

TEST(FidelityEnergy, TheSameWindowsAreAtDistanceZero) {
  const FeatureWindows x = normal_windows(50, 0, 1);
  EXPECT_NEAR(energy_distance(x, x), 0, 1e-12);
}

TEST(FidelityEnergy, TwoPointsAreAsFarApartAsCanBe) {
  const FeatureWindows x{1, {0, 0}};
  const FeatureWindows y{1, {5, 5}};
  EXPECT_DOUBLE_EQ(energy_distance(x, y), 1);
}

TEST(FidelityEnergy, AShiftOfOneStandardDeviationIsFar) {
  EXPECT_GT(energy_distance(normal_windows(60, 0, 1), normal_windows(60, 1, 2)), 0.1);
  EXPECT_LT(energy_distance(normal_windows(60, 0, 1), normal_windows(60, 0, 2)), 0.05);
}

TEST(FidelityEnergy, WindowsHoldRowsThenDifferences) {
  const FeatureWindows windows = motion_windows(std::vector{Stretch{1, {1, 4, 9, 16, 25}}}, 2, 2);
  EXPECT_EQ(windows.values, (std::vector<double>{4, 9, 3, 5, 16, 25, 7, 9}));
}

TEST(FidelityEnergy, WindowsDoNotCrossStretches) {
  const FeatureWindows windows = motion_windows(std::vector{Stretch{1, {1, 2, 3}}, Stretch{1, {1, 2, 4}}}, 2, 1);
  EXPECT_EQ(windows.values, (std::vector<double>{2, 3, 1, 1, 2, 4, 1, 2}));
}

TEST(FidelityEnergy, ThinnedWindowsAreSpreadEvenly) {
  FeatureWindows windows{1, {0, 1, 2, 3, 4, 5}};
  const FeatureWindows few = thinned(windows, 3);
  EXPECT_EQ(few.values, (std::vector<double>{0, 2, 4}));
  EXPECT_EQ(thinned(windows, 9).size(), 6u);
}

TEST(FidelityEnergy, StandardisedFeaturesHaveMeanZeroAndDeviationOne) {
  FeatureWindows x{2, {1, 7, 3, 7}};
  FeatureWindows y{2, {5, 9}};
  standardise(x, y);
  EXPECT_EQ(x.values, (std::vector<double>{-1, 0, 1, 0}));
  EXPECT_EQ(y.values, (std::vector<double>{3, 2}));
}

constexpr double kRateHz = 60;

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

LongDistances apart(const Stretch& a, const Stretch& b) { return long_distances({&a, 1}, {&b, 1}, kRateHz); }

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

TEST(FidelityVerbatim, ACopiedRunIsFoundWhereverItStands) {
  const std::vector real{Stretch{1, {0, 3, 1, 4, 1, 5, 9, 2, 6}}};
  const std::vector copy{Stretch{1, {7, 7, 7, 4, 1, 5, 9, 7, 7}}};
  EXPECT_EQ(longest_verbatim_run(real, copy, 0), 4u);
}

TEST(FidelityVerbatim, EveryChannelMustAgree) {
  const std::vector real{Stretch{2, {0, 0, 1, 1, 2, 2, 3, 3}}};
  const std::vector half{Stretch{2, {0, 9, 1, 9, 2, 9, 3, 9}}};
  EXPECT_EQ(longest_verbatim_run(real, half, 0), 0u);
}

TEST(FidelityVerbatim, ToleranceIsAShareOfTheStandardDeviation) {
  const std::vector real{Stretch{1, {-1, 1, -1, 1}}};
  const std::vector near{Stretch{1, {-0.95, 1.04}}};
  EXPECT_EQ(longest_verbatim_run(real, near, 0.06), 2u);
  EXPECT_EQ(longest_verbatim_run(real, near, 0.03), 0u);
}

TEST(FidelityVerbatim, ARunDoesNotCrossFromOneStretchToTheNext) {
  const std::vector real{Stretch{1, {1, 2, 3, 4}}};
  const std::vector cut{Stretch{1, {1, 2}}, Stretch{1, {3, 4}}};
  EXPECT_EQ(longest_verbatim_run(real, cut, 0), 2u);
}

}  // namespace
}  // namespace wisp::fidelity_distance_test
