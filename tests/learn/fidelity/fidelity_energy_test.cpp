#include "learn/fidelity/fidelity_energy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "learn/numeric/made_series.hpp"

namespace wisp::fidelity_energy_test {
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
  FeatureWindows out{3, {}, {}};
  for (std::size_t i = 0; i < windows; ++i) {
    for (int f = 0; f < 3; ++f) out.values.push_back(gauss(random));
    out.blocks.push_back(i);
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
  EXPECT_NEAR(energy_test(real, other, 0, 1).distance, 0.01459077752966608, 1e-12);
}

TEST(FidelityEnergy, TheSameWindowsAreAtDistanceZero) {
  const FeatureWindows x = normal_windows(50, 0, 1);
  EXPECT_NEAR(energy_test(x, x, 0, 1).distance, 0, 1e-12);
}

TEST(FidelityEnergy, TwoPointsAreAsFarApartAsCanBe) {
  const FeatureWindows x{1, {0, 0}, {0, 1}};
  const FeatureWindows y{1, {5, 5}, {0, 1}};
  EXPECT_DOUBLE_EQ(energy_test(x, y, 0, 1).distance, 1);
}

TEST(FidelityEnergy, AShiftOfOneStandardDeviationIsNoChance) {
  const EnergyTest test = energy_test(normal_windows(60, 0, 1), normal_windows(60, 1, 2), 199, 3);
  EXPECT_DOUBLE_EQ(test.p_value, 1.0 / 200);
}

// Of 40 tests of one distribution against itself the p-values are uniform: their number below 0.25 is binomial with
// mean 10; outside 2 … 20 it is with probability below 0.001.
TEST(FidelityEnergy, OnOneDistributionThePValueIsUniform) {
  int small = 0;
  for (std::uint64_t k = 0; k < 40; ++k) {
    small += energy_test(normal_windows(20, 0, 100 + k), normal_windows(25, 0, 200 + k), 99, k).p_value < 0.25;
  }
  EXPECT_GE(small, 2);
  EXPECT_LE(small, 20);
}

// Each window stands there ten times, as overlapping ones nearly do. Exchanged one by one they would look like far more
// evidence than there is; exchanged in blocks they do not.
TEST(FidelityEnergy, NearCopiesInABlockAreNoEvidence) {
  const auto tenfold = [](const FeatureWindows& windows) {
    FeatureWindows out{windows.features, {}, {}};
    for (std::size_t i = 0; i < windows.size(); ++i) {
      for (int copy = 0; copy < 10; ++copy) {
        out.values.insert(out.values.end(), windows.window(i).begin(), windows.window(i).end());
        out.blocks.push_back(i);
      }
    }
    return out;
  };
  int small = 0;
  for (std::uint64_t k = 0; k < 20; ++k) {
    small +=
        energy_test(tenfold(normal_windows(8, 0, 300 + k)), tenfold(normal_windows(8, 0, 400 + k)), 99, k).p_value <
        0.05;
  }
  EXPECT_LE(small, 5);  // binomial(20, 0.05) exceeds 5 with probability below 0.001
}

TEST(FidelityEnergy, TheSameSeedGivesTheSamePValue) {
  const FeatureWindows x = normal_windows(20, 0, 1);
  const FeatureWindows y = normal_windows(20, 0.3, 2);
  EXPECT_EQ(energy_test(x, y, 99, 5).p_value, energy_test(x, y, 99, 5).p_value);
}

TEST(FidelityEnergy, WindowsHoldRowsThenDifferences) {
  const FeatureWindows windows = motion_windows(std::vector{Stretch{1, {1, 4, 9, 16, 25}}}, 2, 2);
  EXPECT_EQ(windows.values, (std::vector<double>{4, 9, 3, 5, 16, 25, 7, 9}));
  EXPECT_EQ(windows.blocks, (std::vector<std::size_t>{0, 0}));
}

TEST(FidelityEnergy, WindowsOfAnotherStretchAreAnotherBlock) {
  const FeatureWindows windows = motion_windows(std::vector{Stretch{1, {1, 2, 3}}, Stretch{1, {1, 2, 3}}}, 2, 1);
  EXPECT_EQ(windows.blocks, (std::vector<std::size_t>{0, 1}));
}

TEST(FidelityEnergy, ThinnedWindowsAreSpreadEvenly) {
  FeatureWindows windows{1, {0, 1, 2, 3, 4, 5}, {0, 0, 1, 1, 2, 2}};
  const FeatureWindows few = thinned(windows, 3);
  EXPECT_EQ(few.values, (std::vector<double>{0, 2, 4}));
  EXPECT_EQ(few.blocks, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(thinned(windows, 9).size(), 6u);
}

TEST(FidelityEnergy, StandardisedFeaturesHaveMeanZeroAndDeviationOne) {
  FeatureWindows x{2, {1, 7, 3, 7}, {0, 1}};
  FeatureWindows y{2, {5, 9}, {0}};
  standardise(x, y);
  EXPECT_EQ(x.values, (std::vector<double>{-1, 0, 1, 0}));
  EXPECT_EQ(y.values, (std::vector<double>{3, 2}));
}

}  // namespace
}  // namespace wisp::fidelity_energy_test
