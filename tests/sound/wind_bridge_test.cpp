// What is taken for the wind while something else is heard: live, and where the whole recording is known.

#include "sound/wind_bridge.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "sound/wind_sounds.hpp"
#include "wisp/sound/wind_level.hpp"
#include "wisp/sound/wind_track.hpp"

namespace wisp {
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

/// Observations that all are heard; those at `blowing` sound like it.
std::vector<wind::Observation<float>> heard(std::size_t count, const std::vector<std::size_t>& blowing) {
  std::vector<wind::Observation<float>> seen(count);
  for (auto& one : seen) one.loudness_db = 0;
  for (const std::size_t k : blowing) seen[k].likeness = 1;
  return seen;
}

TEST(WindBridge, UnderAnotherSoundTheWindIsAtMostTheLineFromBeforeToAfter) {
  wind::Design d;
  d.trust_frames = 0;
  d.bridge_delay_frames = 1;
  std::vector<float> speeds{1, 1, 9, 9, 1.1F, 9, 2, 2};
  wind::bridge_recording(heard(8, {0, 1, 6, 7}), -60, d, speeds);
  // The other sound began a frame before it was known; 1.1 was measured, so there it is no more.
  const std::vector<float> expected{1, 1, 1.3F, 1.5F, 1.1F, 1.9F, 2, 2};
  for (std::size_t k = 0; k < speeds.size(); ++k) EXPECT_FLOAT_EQ(speeds[k], expected[k]) << k;
}

TEST(WindBridge, AFewFramesThatSoundLikeSomethingElseAreStillWind) {
  wind::Design d;
  std::vector<float> speeds{1, 1, 3, 1, 1};
  wind::bridge_recording(heard(5, {0, 1, 3, 4}), -60, d, speeds);
  EXPECT_EQ(speeds[2], 3.0F);
}

TEST(WindBridge, ARecordingThatIsTalkThroughoutHasNoWind) {
  wind::Design d;
  std::vector<float> speeds(50, 3.0F);
  wind::bridge_recording(heard(50, {}), -60, d, speeds);
  EXPECT_EQ(speeds, std::vector<float>(50, 0.0F));
}

}  // namespace
}  // namespace wisp
