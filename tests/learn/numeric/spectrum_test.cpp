#include "learn/numeric/spectrum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "learn/numeric/made_series.hpp"

namespace wisp::spectrum_test {
namespace {

using Series = std::vector<std::vector<double>>;

// Figures named "numpy" below were computed with numpy's rfft from the same series, Hann window periodic.

TEST(Spectrum, WelchAgreesWithNumpy) {
  const Spectrum spectrum = welch(Series{made::first_series()}, 25, 64);
  ASSERT_EQ(spectrum.power.size(), 33u);
  EXPECT_EQ(spectrum.segments, 5u);
  EXPECT_NEAR(spectrum.power[1], 5.4242453867426816e-05, 1e-14);
  EXPECT_NEAR(spectrum.power[3], 0.8512339751978764, 1e-12);
  EXPECT_NEAR(spectrum.power[11], 0.2024856622443136, 1e-12);
  EXPECT_NEAR(spectrum.power[32], 3.983669120763871e-06, 1e-14);
  EXPECT_DOUBLE_EQ(spectrum.frequency_hz[32], 12.5);
}

TEST(Spectrum, WhiteNoiseHasItsVarianceSpreadEvenly) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> gauss(0, 3);
  std::vector<double> noise(64 * 2000);
  for (double& value : noise) value = gauss(random);
  const Spectrum spectrum = welch(Series{noise}, 60, 64);
  // One-sided density of variance 9 over 30 Hz. About 4000 half-overlapped segments average 0.5 dB-free to 1.9 %
  // (one standard deviation, Welch 1967); five of those bound 31 bins with a false alarm below 1e-4.
  for (std::size_t k = 2; k < 32; ++k) EXPECT_NEAR(spectrum.power[k], 9.0 / 30, 0.1 * 9.0 / 30) << k;
}

TEST(Spectrum, SegmentsDoNotCrossFromOneStretchToTheNext) {
  const std::vector<double> whole = made::first_series(64);
  const std::vector<double> shorter(63, 5.0);
  const Spectrum alone = welch(Series{whole}, 25, 64);
  const Spectrum beside = welch(Series{shorter, whole, shorter}, 25, 64);
  EXPECT_EQ(beside.segments, 1u);
  EXPECT_EQ(beside.power, alone.power);
}

TEST(Spectrum, LogSpectralDistanceAgreesWithNumpy) {
  const Spectrum p = welch(Series{made::first_series()}, 25, 64);
  const Spectrum q = welch(Series{made::second_series()}, 25, 64);
  EXPECT_NEAR(log_spectral_distance(p, q), 15.688327113902627, 1e-9);
}

TEST(Spectrum, TwiceTheAmplitudeIsSixDecibelsAway) {
  std::vector<double> loud = made::first_series();
  for (double& value : loud) value *= 2;
  const Spectrum p = welch(Series{made::first_series()}, 25, 64);
  EXPECT_NEAR(log_spectral_distance(p, welch(Series{loud}, 25, 64)), 20 * std::log10(2.0), 1e-9);
}

TEST(Spectrum, TwoStillChannelsAreAlike) {
  const Spectrum still = welch(Series{std::vector<double>(128, 7.0)}, 25, 64);
  EXPECT_EQ(log_spectral_distance(still, still), 0);
}

TEST(Spectrum, WithoutALongEnoughStretchThereIsNoDistance) {
  const Spectrum none = welch(Series{std::vector<double>(63, 7.0)}, 25, 64);
  EXPECT_TRUE(std::isnan(log_spectral_distance(none, none)));
}

}  // namespace
}  // namespace wisp::spectrum_test
