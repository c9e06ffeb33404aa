// Whoever opens the microphone and blows, talks or sneezes at once has told the estimator nothing wrong: the hard blows
// that follow are strong wind. The sounds are made here; studies/wind has the recorded ones.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "sound/wind_sounds.hpp"
#include "wisp/sound/wind_level.hpp"

namespace wisp::wind_first_sounds_test {
namespace {

using sounds::Samples;

constexpr double kRate = 44100;
constexpr double kStrong = 1.4;  // of wind 1; the candle that the page ships goes out after 0.13 s of 1.38
constexpr int kStrongFrames = 9;

/// A noise that bursts and dies away, as a sneeze.
Samples sneeze() {
  return sounds::blowing(
      0.5, kRate, 0.1, [](double t) { return std::sqrt(t < 0.05 ? t / 0.05 : std::exp(-(t - 0.05) / 0.1)); }, 31);
}

/// Ticks of two resonances, twice a second.
Samples clock() {
  Samples ticks(sounds::count(2, kRate), 0.0F);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const double t = std::fmod(static_cast<double>(i) / kRate, 0.5);
    const double turn = 2 * std::numbers::pi * t;
    ticks[i] = static_cast<float>(std::exp(-t / 0.008) * (std::sin(2100 * turn) + std::sin(740 * turn)));
  }
  return ticks;
}

std::vector<Samples> first_sounds() {
  return {sounds::steady_blowing(0.3, kRate, 0.1, 11),
          sounds::steady_blowing(2.8, kRate, 0.1, 12),
          sounds::voice(1.5, kRate, 110, 0.1, 13),
          sounds::voice(2.5, kRate, 210, 0.1, 14),
          sounds::knocks(1.5, kRate, 0.3, 15),
          sneeze(),
          clock()};
}

/// Whether a hard blow in these frames is strong for long enough.
bool strong_between(const std::vector<WindFrame>& frames, double from, double to) {
  int run = 0;
  for (const WindFrame& frame : frames) {
    const double seconds = static_cast<double>(frame.index) / 60;
    if (seconds < from || seconds > to) continue;
    run = static_cast<double>(frame.wind) > kStrong ? run + 1 : 0;
    if (run == kStrongFrames) return true;
  }
  return false;
}

struct Count {
  int blows = 0;
  int strong = 0;
};

/// `first` from `start` on at an RMS, then three seconds' rest before each of three hard blows.
void count(const Samples& first, double start, double rms, Count& all) {
  Samples loud = first;
  sounds::scale_to(loud, rms);
  const double end = start + static_cast<double>(first.size()) / kRate;
  Samples sound = sounds::room(end + 12, kRate, 3e-4);
  sounds::add(sound, loud, start, kRate);
  for (int k = 0; k < 3; ++k)
    sounds::add(sound, sounds::steady_blowing(0.8, kRate, 0.25, 40 + static_cast<std::uint64_t>(k)), end + 3 + 3 * k,
                kRate);
  auto wind = WindLevel::create({kRate, 1});
  ASSERT_TRUE(wind);
  std::vector<WindFrame> frames(2000);
  frames.resize(wind->feed(std::span<const float>(sound), frames).frames);
  for (int k = 0; k < 3; ++k) {
    ++all.blows;
    all.strong += strong_between(frames, end + 3 + 3 * k, end + 4 + 3 * k) ? 1 : 0;
  }
}

TEST(WindFirstSounds, LeaveTheBlowsAfterThemStrong) {
  Count all;
  for (const Samples& first : first_sounds()) {
    for (const double start : {0.0, 0.4, 1.5, 3.0, 4.5})
      for (const double rms : {0.03, 0.1, 0.3}) count(first, start, rms, all);
  }
  EXPECT_GE(all.strong, 0.95 * all.blows) << all.strong << " of " << all.blows;
}

TEST(WindFirstSounds, AreWindThemselvesWhenTheyAreBlows) {
  Samples sound = sounds::room(2, kRate, 3e-4);
  sounds::add(sound, sounds::steady_blowing(0.8, kRate, 0.25, 21), 0.3, kRate);
  auto wind = WindLevel::create({kRate, 1});
  ASSERT_TRUE(wind);
  std::vector<WindFrame> frames(200);
  frames.resize(wind->feed(std::span<const float>(sound), frames).frames);
  EXPECT_TRUE(strong_between(frames, 0.3, 1.2));
}

}  // namespace
}  // namespace wisp::wind_first_sounds_test
