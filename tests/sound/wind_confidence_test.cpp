// Blowing, talking and knocking, made here at several rates. Shares are of frames of 1/60 s. The sounds are fixed by
// their seeds, so nothing is left to chance; the bounds are those that docs/studies/wind.md promises for real sounds.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "sound/wind_sounds.hpp"
#include "wisp/sound/wind_level.hpp"

namespace wisp::wind_confidence_test {
namespace {

using sounds::Samples;

std::vector<WindFrame> hear(double rate_hz, const Samples& sound) {
  auto wind = WindLevel::create({rate_hz, 1});
  EXPECT_TRUE(wind);
  std::vector<WindFrame> frames(sound.size());
  frames.resize(wind->feed(std::span<const float>(sound), frames).frames);
  return frames;
}

template <class Holds>
double share(const std::vector<WindFrame>& frames, Holds holds) {
  double count = 0;
  for (const WindFrame& frame : frames) count += holds(frame) ? 1 : 0;
  return count / static_cast<double>(frames.size());
}

double share_below(const std::vector<WindFrame>& frames, float confidence) {
  return share(frames, [&](const WindFrame& frame) { return frame.confidence < confidence; });
}

class AtRate : public ::testing::TestWithParam<double> {};

TEST_P(AtRate, AVoiceIsNotBlowing) {
  for (const double pitch_hz : {85.0, 120.0, 180.0, 250.0}) {
    const auto frames = hear(GetParam(), sounds::voice(10, GetParam(), pitch_hz, 0.1));
    EXPECT_GT(share_below(frames, 0.2F), 0.95) << pitch_hz;
    EXPECT_LT(share(frames, [](const WindFrame& frame) { return frame.wind > 0.05F; }), 0.05) << pitch_hz;
  }
}

TEST_P(AtRate, AVoiceInARoomIsNotBlowing) {
  Samples sound = sounds::room(10, GetParam(), 1e-3);
  sounds::add(sound, sounds::voice(9, GetParam(), 120, 0.1), 1, GetParam());
  EXPECT_GT(share_below(hear(GetParam(), sound), 0.2F), 0.95);
}

TEST_P(AtRate, KnocksAreNotBlowing) {
  Samples sound = sounds::room(10, GetParam(), 1e-3);
  sounds::add(sound, sounds::knocks(10, GetParam(), 0.4), 0, GetParam());
  EXPECT_GT(share_below(hear(GetParam(), sound), 0.2F), 0.95);
}

TEST_P(AtRate, BassChordsAreNotBlowing) {
  const double rate = GetParam();
  Samples sound = sounds::room(9, rate, 3e-4);
  sounds::add(sound, sounds::chords(9, rate, 0.1), 0, rate);
  EXPECT_GT(share_below(hear(rate, sound), 0.2F), 0.9);  // all but the beginning of the first
}

TEST_P(AtRate, ARoomIsNotBlowing) {
  EXPECT_GT(share_below(hear(GetParam(), sounds::room(10, GetParam(), 1e-3)), 0.2F), 0.98);
}

TEST_P(AtRate, GustsAreBlowingFrom15DecibelsAboveTheRoom) {
  const double rate = GetParam();
  Samples sound = sounds::room(12, rate, 1e-3);
  const auto gust = [](double t) { return std::sqrt(std::sin(1.57 * t)); };
  for (int i = 0; i < 3; ++i) {
    sounds::add(sound, sounds::blowing(2, rate, 0.1, gust, 7 + static_cast<std::uint64_t>(i)), 2 + 3 * i, rate);
  }
  double loud = 0;
  double sure = 0;
  for (const WindFrame& frame : hear(rate, sound)) {
    if (static_cast<double>(frame.rms) < 1e-3 * std::pow(10, 15.0 / 20)) continue;
    loud += 1;
    sure += frame.confidence > 0.8F ? 1 : 0;
  }
  EXPECT_GT(loud, 280);
  EXPECT_GT(sure / loud, 0.85);
}

TEST_P(AtRate, AGustIsKnownForOneWithin100Milliseconds) {
  const double rate = GetParam();
  Samples sound = sounds::room(4, rate, 1e-3);
  sounds::add(sound, sounds::steady_blowing(2, rate, 0.1), 2, rate);
  const auto frames = hear(rate, sound);
  for (std::size_t k = 126; k < 180; ++k) EXPECT_GT(frames[k].confidence, 0.8F) << k;
}

INSTANTIATE_TEST_SUITE_P(WindConfidence, AtRate,
                         ::testing::Values(8000.0, 11025.0, 16000.0, 22050.0, 44100.0, 48000.0, 96000.0, 192000.0),
                         [](const auto& rate) { return std::to_string(static_cast<int>(rate.param)); });

TEST(WindConfidence, ALastPuffThatDiesAwayIsStillTheGust) {
  Samples sound = sounds::room(5, 44100, 1e-4);
  sounds::add(sound, sounds::steady_blowing(1, 44100, 0.1), 2, 44100);
  // The puff by itself is a low hum, which is not blowing.
  Samples hum(44100 / 4);
  for (std::size_t i = 0; i < hum.size(); ++i) {
    const double t = static_cast<double>(i) / 44100;
    hum[i] = static_cast<float>(0.03 * std::exp(-t / 0.1) * std::sin(2 * std::numbers::pi * 120 * t));
  }
  Samples alone = sounds::room(5, 44100, 1e-4);
  sounds::add(alone, hum, 3, 44100);
  sounds::add(sound, hum, 3, 44100);
  EXPECT_GT(hear(44100, sound)[186].confidence, 0.8F);
  EXPECT_LT(hear(44100, alone)[186].confidence, 0.2F);
}

TEST(WindConfidence, AVoiceAfterAGustIsAVoice) {
  Samples sound = sounds::room(8, 44100, 1e-4);
  sounds::add(sound, sounds::steady_blowing(1, 44100, 0.1), 2, 44100);
  sounds::add(sound, sounds::voice(4, 44100, 120, 0.1), 3.2, 44100);
  const auto frames = hear(44100, sound);
  EXPECT_GT(share_below({frames.begin() + 210, frames.end()}, 0.2F), 0.95);
}

TEST(WindConfidence, AFanIsTakenForTheRoomInTheEnd) {
  Samples sound = sounds::room(50, 16000, 1e-3);
  sounds::add(sound, sounds::steady_blowing(45, 16000, 0.02), 5, 16000);
  const auto frames = hear(16000, sound);
  EXPECT_GT(frames[60 * 7].confidence, 0.8F);
  EXPECT_LT(frames[60 * 49].confidence, 0.2F);
}

TEST(WindConfidence, AFanIsWindForeverWhenTheFloorMayNotRise) {
  auto wind = WindLevel::create({16000, 1}, {.floor_rise_db_per_second = 0});
  ASSERT_TRUE(wind);
  Samples sound = sounds::room(50, 16000, 1e-3);
  sounds::add(sound, sounds::steady_blowing(45, 16000, 0.02), 5, 16000);
  std::vector<WindFrame> frames(3000);
  ASSERT_EQ(wind->feed(std::span<const float>(sound), frames).frames, 3000U);
  EXPECT_GT(frames.back().confidence, 0.8F);
}

TEST(WindConfidence, AStreamThatBeginsWithNothingAtAllIsNoQuietRoom) {
  Samples sound(16000 * 2, 0.0F);  // muted, then a room with a low rumble
  Samples rumble = sounds::room(6, 16000, 1e-4);
  sounds::add(rumble, sounds::steady_blowing(6, 16000, 3e-4), 0, 16000);
  sounds::add(sound, rumble, 2, 16000);
  EXPECT_GT(share_below(hear(16000, sound), 0.2F), 0.97);
}

}  // namespace
}  // namespace wisp::wind_confidence_test
