#include "simulate/candle/wind_signal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace wisp::virtual_microphone_test {
namespace {

using testing::HasSubstr;

std::vector<float> heard(const VirtualMicrophoneOptions& options, float wind, int samples) {
  VirtualMicrophone microphone = std::move(*VirtualMicrophone::create(options));
  std::vector<float> sound(samples);
  microphone.hear(std::vector<float>(samples, wind), sound);
  return sound;
}

double rms(const std::vector<float>& sound) {
  double sum = 0;
  for (const float x : sound) sum += static_cast<double>(x) * static_cast<double>(x);
  return std::sqrt(sum / static_cast<double>(sound.size()));
}

// Power around a frequency: mean over blocks of 0.1 s.
double power_at(const std::vector<float>& sound, double frequency_hz) {
  double power = 0;
  for (std::size_t block = 0; block + 4410 <= sound.size(); block += 4410) {
    double c = 0;
    double s = 0;
    for (std::size_t k = 0; k < 4410; ++k) {
      const double phase = 2 * 3.14159265358979323846 * frequency_hz * static_cast<double>(k) / 44100;
      c += static_cast<double>(sound[block + k]) * std::cos(phase);
      s += static_cast<double>(sound[block + k]) * std::sin(phase);
    }
    power += c * c + s * s;
  }
  return power;
}

// 4 s of noise in a 300 Hz band: about 2400 independent values, so a level is known to 1.5 %; the bounds are four of
// that.
TEST(VirtualMicrophone, LevelGoesWithThePowerOfTheWind) {
  for (const double exponent : {1.5, 2.0}) {
    const VirtualMicrophoneOptions options{.exponent = exponent, .level = 0.05, .hiss = 0, .other_sounds = 0};
    EXPECT_NEAR(rms(heard(options, 1, 4 * 44100)), 0.05, 0.003);
    EXPECT_NEAR(rms(heard(options, 0.5F, 4 * 44100)) / (0.05 * std::pow(0.5, exponent)), 1, 0.06);
    EXPECT_EQ(heard(options, -0.5F, 100), heard(options, 0.5F, 100));
  }
}

TEST(VirtualMicrophone, SpectrumIsFlatBelowTheCornerAndFallsAbove) {
  const auto sound = heard({.hiss = 0, .other_sounds = 0}, 1, 8 * 44100);
  const auto decibels = [&](double a, double b) { return 10 * std::log10(power_at(sound, b) / power_at(sound, a)); };
  // 80 blocks: a power is known to ±0.5 dB, one standard error.
  EXPECT_NEAR(decibels(40, 150), 0, 2.5);
  EXPECT_NEAR(decibels(40, 1200), -24, 3);
}

TEST(VirtualMicrophone, HearsOnlyHissInCalmAir) {
  const auto sound = heard({.hiss = 1e-3, .other_sounds = 0}, 0, 44100);
  EXPECT_NEAR(rms(sound), 1e-3, 2e-5);
}

TEST(VirtualMicrophone, HearsNowAndThenWhatIsNotWind) {
  VirtualMicrophone microphone = std::move(*VirtualMicrophone::create({.hiss = 0, .other_sounds = 0.5}));
  const std::vector<float> calm(4410, 0.0F);
  std::vector<float> sound(4410);
  int blocks = 0;
  for (int k = 0; k < 600; ++k) {
    microphone.hear(calm, sound);
    blocks += rms(sound) > 0 ? 1 : 0;
  }
  // A minute: thirty sounds of half a second.
  EXPECT_GT(blocks, 60);
  EXPECT_LT(blocks, 400);
}

TEST(VirtualMicrophone, IsTheSameHoweverTheBlocksAreCut) {
  const VirtualMicrophoneOptions options{.other_sounds = 5};
  const auto whole = heard(options, 0.7F, 30000);
  VirtualMicrophone microphone = std::move(*VirtualMicrophone::create(options));
  std::vector<float> pieces;
  for (std::size_t size = 1; pieces.size() < whole.size(); size = size * 3 % 1009 + 1) {
    std::vector<float> block(std::min(size, whole.size() - pieces.size()));
    microphone.hear(std::vector<float>(block.size(), 0.7F), block);
    pieces.insert(pieces.end(), block.begin(), block.end());
  }
  EXPECT_EQ(pieces, whole);
}

TEST(VirtualMicrophone, ClipsWhatIsTooLoud) {
  const auto sound = heard({}, 8, 4410);
  EXPECT_EQ(*std::max_element(sound.begin(), sound.end()), 1.0F);
  EXPECT_EQ(*std::min_element(sound.begin(), sound.end()), -1.0F);
}

TEST(VirtualMicrophone, SaysWhichOptionIsWrong) {
  EXPECT_THAT(VirtualMicrophone::create({.exponent = 9}).error().message, HasSubstr("exponent"));
  EXPECT_THAT(VirtualMicrophone::create({.rate_hz = 8000, .corner_hz = 4500}).error().message, HasSubstr("corner_hz"));
}

}  // namespace
}  // namespace wisp::virtual_microphone_test
