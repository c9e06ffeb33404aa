#include "wisp/sound/wind_track.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "sound/wind_sounds.hpp"

namespace wisp::wind_track_test {
namespace {

using sounds::Samples;
using ::testing::HasSubstr;

WindTrack track_of(const Samples& sound, double rate_hz = 44100, const WindOptions& options = {}) {
  auto track = wind_from_sound(sound, {rate_hz, 1}, options);
  EXPECT_TRUE(track) << track.error().message;
  return std::move(track).value();
}

/// Wind from the start, then rest, then wind.
Samples blow_rest_blow(double room_rms = 1e-3) {
  Samples sound = sounds::room(9, 44100, room_rms);
  sounds::add(sound, sounds::steady_blowing(3, 44100, 0.1), 0, 44100);
  sounds::add(sound, sounds::steady_blowing(3, 44100, 0.1, 8), 6, 44100);
  return sound;
}

double mean_of(const WindTrack& track, float WindFrame::*field, std::size_t from, std::size_t to) {
  double sum = 0;
  for (std::size_t k = from; k < to; ++k) sum += static_cast<double>(track.frames[k].*field);
  return sum / static_cast<double>(to - from);
}

TEST(WindTrack, BackgroundIsTheMeanOfTheStretchesWithoutWind) {
  const WindTrack track = track_of(blow_rest_blow());
  EXPECT_TRUE(track.background_found);
  EXPECT_NEAR(track.calibration.background_rms, 1e-3, 2e-5);
  // The 50 ms mean takes half a second to fall by the 40 dB between gust and room.
  EXPECT_NEAR(track.quiet_share, 1.0 / 3, 0.07);
  EXPECT_NEAR(track.blowing_share, 2.0 / 3, 0.06);
  for (const WindFrame& frame : track.frames) {
    EXPECT_EQ(frame.background, track.calibration.background_rms);
    EXPECT_EQ(frame.rms_clean, std::max(frame.rms - frame.background, 0.0F));
  }
}

TEST(WindTrack, TheFirstGustIsHeardThoughTheRoomComesAfterIt) {
  const WindTrack track = track_of(blow_rest_blow());
  EXPECT_GT(mean_of(track, &WindFrame::confidence, 6, 180), 0.9);
}

TEST(WindTrack, WindOneIsThe95thPercentileWhileItBlows) {
  const WindTrack track = track_of(blow_rest_blow());
  EXPECT_GT(track.one_rms, 0.0F);
  EXPECT_EQ(track.one_rms, track.calibration.gust_rms);
  std::vector<float> blowing;
  for (const WindFrame& frame : track.frames) {
    if (frame.confidence > 0.8F) blowing.push_back(frame.speed);
  }
  std::sort(blowing.begin(), blowing.end());
  EXPECT_NEAR(blowing[blowing.size() * 95 / 100], 1, 0.01);
}

// Brighter than most wind, and then only just told for it: frames that are surely blowing are the soft ends of the
// gusts, and wind 1 must not be taken from those.
TEST(WindTrack, WindOneIsThatOfTheHardGustsWhereBlowingIsBarelyTold) {
  for (const double rate_hz : {8000.0, 16000.0, 44100.0}) {
    Samples sound = sounds::room(12, rate_hz, 1e-4);
    for (int gust = 0; gust < 5; ++gust) {
      Samples blown = sounds::room(1.2, rate_hz, 1, 20 + static_cast<std::uint64_t>(gust));
      const double share = 1 - std::exp(-2 * std::numbers::pi * 500 / rate_hz);  // falls by 6 dB an octave from 500 Hz
      double low = 0;
      for (std::size_t i = 0; i < blown.size(); ++i) {
        low += share * (static_cast<double>(blown[i]) - low);
        const double wind = std::sin(std::numbers::pi * static_cast<double>(i) / static_cast<double>(blown.size()));
        blown[i] = static_cast<float>(0.3 * wind * wind * low / std::sqrt(share / 2));
      }
      sounds::add(sound, blown, 1 + 2 * gust, rate_hz);
    }
    const WindTrack track = track_of(sound, rate_hz, {.frame_rate_hz = 30});
    float strongest = 0;
    for (const WindFrame& frame : track.frames) strongest = std::max(strongest, frame.wind);
    EXPECT_GT(strongest, 0.9F) << rate_hz;
    EXPECT_LT(strongest, 1.4F) << rate_hz;
  }
}

TEST(WindTrack, BlocksOfAnySizeGiveTheSameTrack) {
  const Samples sound = blow_rest_blow();
  const WindTrack whole = track_of(sound);
  auto tracker = WindTracker::create({44100, 1});
  ASSERT_TRUE(tracker);
  for (std::size_t i = 0; i < sound.size(); i += 777) {
    tracker->feed(std::span(sound).subspan(i, std::min<std::size_t>(777, sound.size() - i)));
  }
  const auto track = tracker->finish();
  ASSERT_TRUE(track);
  ASSERT_EQ(track->frames.size(), whole.frames.size());
  for (std::size_t k = 0; k < whole.frames.size(); ++k) EXPECT_EQ(track->frames[k].speed, whole.frames[k].speed);
}

TEST(WindTrack, SoundShorterThanTheVideoGivesFewerFrames) {
  EXPECT_EQ(track_of(sounds::room(1.99, 44100, 1e-3)).frames.size(), 119U);
}

// Gusts so faint that what is put beside them is many times wind 1.
Samples faint_gusts() {
  Samples sound = sounds::room(14, 44100, 1e-5);
  for (int k = 0; k < 4; ++k) {
    sounds::add(sound, sounds::steady_blowing(2, 44100, 5e-4, 8 + static_cast<std::uint64_t>(k)), 1 + 3 * k, 44100);
  }
  return sound;
}

float strongest(const WindTrack& track) { return std::ranges::max_element(track.frames, {}, &WindFrame::wind)->wind; }

TEST(WindTrack, AKnockBesideFaintWindIsNoWind) {
  Samples sound = faint_gusts();
  sounds::add(sound, sounds::knocks(1, 44100, 0.9), 1.5, 44100);
  const WindTrack track = track_of(sound);
  EXPECT_GT(std::ranges::max_element(track.frames, {}, &WindFrame::speed)->speed, 6);  // it is heard
  EXPECT_LT(strongest(track), 2);
}

TEST(WindTrack, KnocksOnTheTableInAStillRoomAreNoWind) {
  for (const double peak : {0.1, 0.3, 0.8}) {
    Samples sound = sounds::room(12, 44100, 1e-3);
    sounds::add(sound, sounds::knocks(10, 44100, peak), 1, 44100);
    EXPECT_LT(strongest(track_of(sound)), 0.2) << peak;
  }
}

TEST(WindTrack, ShortPeaksOfAGustCloseTogetherAreWind) {
  Samples sound = sounds::room(8, 44100, 1e-4);
  const auto gusty = [](double t) { return std::fmod(t, 0.14) < 0.05 ? 1.0 : 0.05; };
  sounds::add(sound, sounds::blowing(4, 44100, 0.02, gusty), 2, 44100);
  const WindTrack track = track_of(sound);
  const auto blows = [](const WindFrame& frame) { return frame.wind > 0.3F; };
  EXPECT_GT(std::ranges::count_if(track.frames, blows), 60) << "of 4 s";
}

TEST(WindTrack, AHardPuffBesideFaintWindIsWind) {
  for (std::uint64_t seed = 20; seed < 28; ++seed) {  // where in the puff its strongest frame lies is chance
    Samples sound = faint_gusts();
    sounds::add(sound, sounds::steady_blowing(0.2, 44100, 0.3, seed), 8, 44100);
    EXPECT_GT(strongest(track_of(sound)), 6) << seed;
  }
}

TEST(WindTrack, ASilentTrackSaysSo) {
  const WindTrack track = track_of(Samples(44100, 0.0F));
  EXPECT_TRUE(track.silent);
  EXPECT_EQ(track.blowing_share, 0.0F);
  EXPECT_EQ(track.calibration.gust_rms, 0.0F);
  for (const WindFrame& frame : track.frames) EXPECT_EQ(frame.wind, 0.0F);
  EXPECT_FALSE(track_of(sounds::room(1, 44100, 1e-3)).silent);
}

TEST(WindTrack, ARoomWithoutWindHasNone) {
  const WindTrack track = track_of(sounds::room(5, 44100, 1e-3));
  EXPECT_TRUE(track.background_found);
  EXPECT_GT(track.quiet_share, 0.95F);
  EXPECT_EQ(track.calibration.gust_rms, 0.0F);
  EXPECT_NEAR(track.one_rms, WindOptions{}.first_gust_rms, 1e-6);
  EXPECT_LT(mean_of(track, &WindFrame::wind, 0, 300), 1e-3);
}

TEST(WindTrack, SaysWhenNoStretchWasWithoutWind) {
  // Wind that swings without a rest: it passes the softest level again and again and never stays there.
  const auto swing = [](double t) { return 0.6 + 0.4 * std::sin(2 * std::numbers::pi * 2 * t); };
  EXPECT_FALSE(track_of(sounds::blowing(10, 44100, 0.1, swing)).background_found);
}

TEST(WindTrack, TheShareThatBlowsIsThatOfTheWindThatIsWritten) {
  const WindTrack track = track_of(blow_rest_blow());
  const auto windy =
      std::count_if(track.frames.begin(), track.frames.end(), [](const WindFrame& f) { return f.wind > 0.05F; });
  EXPECT_GT(windy, 0);
  EXPECT_NEAR(track.blowing_share, static_cast<double>(windy) / static_cast<double>(track.frames.size()), 1e-5);
}

TEST(WindTrack, SilenceBeforeTheSoundBeginsIsNoRoom) {
  Samples sound(44100, 0.0F);
  sounds::add(sound, blow_rest_blow(), 1, 44100);
  EXPECT_NEAR(track_of(sound).calibration.background_rms, 1e-3, 2e-5);
}

TEST(WindTrack, ClippedSoundIsTakenAndToldOf) {
  Samples sound = blow_rest_blow();
  for (float& x : sound) x = std::clamp(20 * x, -1.0F, 1.0F);
  const WindTrack track = track_of(sound);
  EXPECT_GT(track.clipped_share, 0.3F);
  EXPECT_GT(mean_of(track, &WindFrame::confidence, 6, 180), 0.8);
  EXPECT_GT(mean_of(track, &WindFrame::wind, 6, 180), 0.7);
}

TEST(WindTrack, SaysWhatItCannotDo) {
  EXPECT_THAT(wind_from_sound(Samples(100), {4000, 1}).error().message, HasSubstr("the sound's rate is 4000 Hz"));
  EXPECT_THAT(wind_from_sound(Samples(100), {44100, 1}).error().message,
              HasSubstr("the sound lasts 0.002268 s, expected at least one video frame (0.016667 s)"));
}

}  // namespace
}  // namespace wisp::wind_track_test
