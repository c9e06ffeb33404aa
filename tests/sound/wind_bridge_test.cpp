// What is taken for the wind while something else is heard: live, and where the whole recording is known.

#include "sound/wind_verdict.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sound/wind_sounds.hpp"
#include "wisp/sound/wind_level.hpp"
#include "wisp/sound/wind_track.hpp"

namespace wisp::wind_bridge_test {
namespace {

using sounds::Samples;

constexpr double kRate = 44100;

/// Blowing from 1 to 5 s, somebody loud talking from 2.5 to 4 s into it.
Samples talk_into_wind() {
  Samples sound = sounds::room(6, kRate, 1e-3);
  sounds::add(sound, sounds::steady_blowing(4, kRate, 0.05), 1, kRate);
  sounds::add(sound, sounds::voice(1.5, kRate, 130, 0.3), 2.5, kRate);
  return sound;
}

std::vector<WindFrame> live(const Samples& sound) {
  auto level = WindLevel::create({kRate, 1});
  EXPECT_TRUE(level);
  std::vector<WindFrame> frames(sound.size());
  frames.resize(level->feed(std::span<const float>(sound), frames).frames);
  return frames;
}

std::vector<WindFrame> known(const Samples& sound) {
  auto track = wind_from_sound(sound, {kRate, 1});
  EXPECT_TRUE(track);
  return track->frames;
}

double mean(const std::vector<WindFrame>& frames, float WindFrame::*field, double from, double to) {
  double sum = 0;
  double count = 0;
  for (auto k = static_cast<std::size_t>(from * 60); k < static_cast<std::size_t>(to * 60); ++k) {
    sum += static_cast<double>(frames[k].*field);
    count += 1;
  }
  return sum / count;
}

TEST(WindBridge, TalkIntoWindDoesNotRaiseIt) {
  for (const auto& frames : {live(talk_into_wind()), known(talk_into_wind())}) {
    const double before = mean(frames, &WindFrame::wind, 1.5, 2.4);
    EXPECT_GT(mean(frames, &WindFrame::speed, 2.6, 4), 1.1 * before);  // what was measured is the voice
    EXPECT_LT(mean(frames, &WindFrame::wind, 2.6, 4), 1.06 * before);
  }
}

TEST(WindBridge, ARecordingsWindGoesOnUnderTalk) {
  const auto frames = known(talk_into_wind());
  EXPECT_GT(mean(frames, &WindFrame::wind, 2.6, 4), 0.6 * mean(frames, &WindFrame::wind, 1.5, 2.4));
}

TEST(WindBridge, TalkInAStillRoomIsNoWind) {
  Samples sound = sounds::room(6, kRate, 1e-3);
  sounds::add(sound, sounds::voice(4, kRate, 130, 0.3), 1, kRate);
  EXPECT_LT(mean(live(sound), &WindFrame::wind, 1, 5), 0.02);
  EXPECT_LT(mean(known(sound), &WindFrame::wind, 1, 5), 0.02);
}

TEST(WindBridge, WindThatSwingsFastLosesNothing) {
  const auto swing = [](double t) { return 0.6 + 0.4 * std::sin(2 * std::numbers::pi * 5 * t); };
  Samples sound = sounds::room(6, kRate, 1e-3);
  sounds::add(sound, sounds::blowing(4, kRate, 0.1, swing), 1, kRate);
  const auto after = known(sound);
  EXPECT_GT(mean(after, &WindFrame::wind, 1.2, 4.8), 0.99 * mean(after, &WindFrame::speed, 1.2, 4.8));
  const auto now = live(sound);
  EXPECT_GT(mean(now, &WindFrame::wind, 1.2, 4.8), 0.95 * mean(now, &WindFrame::speed, 1.2, 4.8));
}

TEST(WindBridge, KnocksOnATableAreHardlyAnyWindLive) {
  int frames_with_wind = 0;
  float most = 0;
  for (std::uint64_t seed = 31; seed < 35; ++seed) {
    Samples sound = sounds::room(13, kRate, 3e-4);
    sounds::add(sound, sounds::knocks(10, kRate, 0.4, seed), 2, kRate);
    for (const WindFrame& frame : live(sound)) {
      frames_with_wind += frame.wind > 0.3F;
      most = std::max(most, frame.wind);
    }
  }
  EXPECT_LT(frames_with_wind, 0.5 * 4 * 16);  // of 16 knocks each
  EXPECT_LT(most, 0.9F);
}

/// Blowing from 1 to 3 s, a gust under one word from 4 to 5 s, and talk over blowing until the end.
TEST(WindBridge, ARecordingReadsTheWindBetweenAVoicesHarmonics) {
  Samples sound = sounds::room(8, kRate, 1e-3);
  sounds::add(sound, sounds::steady_blowing(2, kRate, 0.05), 1, kRate);
  sounds::add(sound, sounds::voice(1.6, kRate, 130, 0.1), 3.7, kRate);
  sounds::add(sound, sounds::steady_blowing(1, kRate, 0.05, 5), 4, kRate);
  sounds::add(sound, sounds::steady_blowing(2, kRate, 0.05, 6), 6, kRate);
  sounds::add(sound, sounds::voice(1.4, kRate, 130, 0.1), 6.6, kRate);
  const auto frames = known(sound);
  const double alone = mean(frames, &WindFrame::wind, 1.2, 2.8);
  EXPECT_NEAR(mean(frames, &WindFrame::wind, 4.2, 4.9), alone, 0.2 * alone);
  EXPECT_NEAR(mean(frames, &WindFrame::wind, 6.8, 7.9), alone, 0.2 * alone);
  EXPECT_LT(mean(frames, &WindFrame::wind, 3.75, 3.95), 0.2 * alone);
}

TEST(WindBridge, ARecordingThatIsTalkThroughoutHasNoWind) {
  EXPECT_LT(mean(known(sounds::voice(6, kRate, 130, 0.1)), &WindFrame::wind, 0.5, 5.5), 0.02);
}

}  // namespace
}  // namespace wisp::wind_bridge_test
