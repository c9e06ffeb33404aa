#include "learn/fidelity/fidelity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace wisp::fidelity_test {
namespace {

// Two channels of a damped resonance, shaken by noise.
Recording resonance(std::size_t rows, double frequency_hz, std::uint64_t seed, double amplitude = 1) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss(0, amplitude);
  Recording recording;
  recording.source = "resonance " + std::to_string(seed);
  recording.rate_hz = 30;
  const double radius = 0.93;
  const double turn = 2 * radius * std::cos(2 * 3.14159265358979 * frequency_hz / recording.rate_hz);
  for (const char* name : {"x", "y"}) {
    Channel channel{name, "", Role::kOutput, {}};
    double last = 0;
    double before = 0;
    for (std::size_t t = 0; t < rows + 200; ++t) {
      const double now = turn * last - radius * radius * before + gauss(random);
      before = last;
      last = now;
      if (t >= 200) channel.samples.push_back(now);
    }
    recording.channels.push_back(std::move(channel));
  }
  return recording;
}

Fidelity compared(const std::vector<Recording>& real, const std::vector<Recording>& made) {
  auto result = fidelity(real, made);
  EXPECT_TRUE(result);
  return *result;
}

double over_floor(const Bounded& measure) { return measure.value / measure.floor; }

TEST(Fidelity, TheSameProcessIsNearTheFloorInEveryMeasure) {
  const Fidelity f = compared({resonance(900, 5, 1), resonance(900, 5, 2)}, {resonance(1800, 5, 3)});
  EXPECT_LT(over_floor(f.log_spectral_distance), 1.5);
  EXPECT_LT(over_floor(f.energy_distance), 1.5);
  EXPECT_LT(f.energy_distance.value, 0.25 * f.energy_distance.ceiling);
}

TEST(Fidelity, AnotherFrequencyIsSeen) {
  const Fidelity f = compared({resonance(900, 5, 1), resonance(900, 5, 2)}, {resonance(1800, 2.5, 3)});
  EXPECT_GT(over_floor(f.log_spectral_distance), 2);
  EXPECT_GT(over_floor(f.energy_distance), 4);
}

TEST(Fidelity, TwiceTheAmplitudeIsSeen) {
  const Fidelity f = compared({resonance(900, 5, 1), resonance(900, 5, 2)}, {resonance(1800, 5, 3, 2)});
  EXPECT_NEAR(f.channels[0].sd_synthesized / f.channels[0].sd_real, 2, 0.3);
}

TEST(Fidelity, ShuffledFramesLoseTheirMotion) {
  const Fidelity f = compared({resonance(900, 5, 1), resonance(900, 5, 2)}, {resonance(900, 5, 3)});
  EXPECT_GT(f.log_spectral_distance.ceiling, 3 * f.log_spectral_distance.floor);
}

TEST(Fidelity, ACopyIsFoundOut) {
  const Recording real = resonance(300, 5, 1);
  const Fidelity f = compared({real}, {slice(real, 50, 200)});
  EXPECT_DOUBLE_EQ(f.verbatim_seconds, 150 / 30.0);
}

TEST(Fidelity, ASingleRecordingIsHalvedInTimeAndShortensTheSegments) {
  const Fidelity f = compared({resonance(100, 5, 1)}, {resonance(600, 5, 2)});
  EXPECT_EQ(f.welch_samples, 50u);
}

TEST(Fidelity, TooLittleDataIsAClearError) {
  const std::vector real{resonance(30, 5, 1)};
  const std::vector made{resonance(100, 5, 2)};
  const auto result = fidelity(real, made);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().message,
            "resonance 1: its first half has 15 consecutive complete rows at most; fidelity needs at least 16");
}

TEST(Fidelity, RatesMustAgree) {
  const std::vector real{resonance(100, 5, 1)};
  std::vector made{resonance(100, 5, 2)};
  made[0].rate_hz = 25;
  const auto result = fidelity(real, made);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("resonance 2: has 25"), std::string::npos);
}

TEST(Fidelity, MotionAloneHasTheSameDistancesAndNoOtherLongFigures) {
  const std::vector real{resonance(900, 5, 1)};
  const std::vector made{resonance(900, 5, 2)};
  const auto all = fidelity(real, made), motion = fidelity(real, made, {.motion_only = true});
  ASSERT_TRUE(std::isfinite(all->long_motion.value) && std::isfinite(all->long_spectra.value));
  EXPECT_EQ(motion->long_motion.value, all->long_motion.value);
  EXPECT_EQ(motion->energy_distance.value, all->energy_distance.value);
  EXPECT_TRUE(std::isnan(motion->long_spectra.value) && std::isnan(motion->verbatim_seconds));
}

TEST(Fidelity, TheSameSeedGivesTheSameFigures) {
  const std::vector real{resonance(200, 5, 1)};
  const std::vector made{resonance(200, 5, 2)};
  EXPECT_EQ(fidelity(real, made)->energy_distance.ceiling, fidelity(real, made)->energy_distance.ceiling);
}

}  // namespace
}  // namespace wisp::fidelity_test
