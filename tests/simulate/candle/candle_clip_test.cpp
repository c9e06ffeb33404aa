#include "wisp/simulate/candle_clip.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "simulate/candle/candle_rig.hpp"

namespace wisp::candle_clip_test {
namespace {

using testing::HasSubstr;

// Half a second after 0.3 s of burning in.
CandleClipOptions short_clip() {
  CandleClipOptions options;
  options.seconds = 0.5;
  options.settle_seconds = 0.3;
  return options;
}

struct Clip {
  std::vector<std::uint8_t> pictures;
  std::vector<float> sound;
  std::vector<double> progress;
  Recording truth;
};

Clip shoot(const CandleClipOptions& options) {
  Clip clip;
  CandleClipOutputs outputs;
  outputs.on_frame = [&](const CandleFrame& frame) -> Result<void> {
    clip.pictures.insert(clip.pictures.end(), frame.picture.begin(), frame.picture.end());
    return {};
  };
  outputs.on_sound = [&](std::span<const float> sound) -> Result<void> {
    clip.sound.insert(clip.sound.end(), sound.begin(), sound.end());
    return {};
  };
  outputs.on_progress = [&](double share) { clip.progress.push_back(share); };
  clip.truth = *simulate_candle(options, outputs);
  return clip;
}

const Channel& channel(const Recording& recording, const std::string& name) {
  for (const Channel& c : recording.channels)
    if (c.name == name) return c;
  ADD_FAILURE() << "no channel " << name;
  return recording.channels.front();
}

TEST(CandleClip, HasAPictureARowAndItsShareOfSoundForEveryFrame) {
  const Clip clip = shoot(short_clip());
  EXPECT_EQ(clip.truth.rows(), 30U);
  EXPECT_EQ(clip.pictures.size(), 30U * 320 * 480 * 3);
  EXPECT_EQ(clip.sound.size(), 22050U);
  EXPECT_EQ(clip.progress.size(), 30U);
  EXPECT_DOUBLE_EQ(clip.progress.back(), 1);
  EXPECT_EQ(clip.truth.rate_hz, 60);
}

TEST(CandleClip, TruthHoldsWindTipAndOutlineWhereThePictureHasThem) {
  const Clip clip = shoot(short_clip());
  EXPECT_TRUE(check(clip.truth));
  EXPECT_EQ(channel(clip.truth, "wind").role, Role::kInput);
  EXPECT_EQ(channel(clip.truth, "lit").samples.back(), 1);
  const double tip_x = 0.35 * 320 - 0.5 + 7.5 * channel(clip.truth, "tip.x").samples.back();
  const double tip_y = 0.94 * 480 - 0.5 - 7.5 * channel(clip.truth, "tip.y").samples.back();
  const auto value_at = [&](double x, double y) {
    const std::size_t k =
        29U * 320 * 480 + static_cast<std::size_t>(std::lround(y)) * 320 + static_cast<std::size_t>(std::lround(x));
    return static_cast<int>(clip.pictures[3 * k]);
  };
  // Bright three millimetres below the tip, dark three above; the outline's highest control points are near it.
  EXPECT_GT(value_at(tip_x, tip_y + 22), 128);
  EXPECT_LT(value_at(tip_x, tip_y - 22), 64);
  EXPECT_NEAR(channel(clip.truth, "p4.x").samples.back(), tip_x, 40);
}

TEST(CandleClip, FollowsARecordedWind) {
  CandleClipOptions options = short_clip();
  options.wind_recording.emplace();
  options.wind_recording->source = "wind.csv";
  options.wind_recording->rate_hz = 10;
  options.wind_recording->channels = {{"wind", "m/s", Role::kInput, std::vector<double>(6, 0.4)}};
  const Clip clip = shoot(options);
  for (const double wind : channel(clip.truth, "wind").samples) EXPECT_DOUBLE_EQ(wind, 0.4);
  EXPECT_GT(channel(clip.truth, "lean").samples.back(), 10);
}

TEST(CandleClip, RefusesBlowOutsAndPuffsBesideARecordedWind) {
  CandleClipOptions options = short_clip();
  options.wind_recording.emplace();
  options.wind_recording->source = "wind.csv";
  options.wind_recording->rate_hz = 10;
  options.wind_recording->channels = {{"wind", "m/s", Role::kInput, std::vector<double>(6, 0.4)}};
  CandleClipOptions puffs = options;
  options.wind.blow_out_at = 0.1;
  puffs.wind.puff_every = 5;
  for (const CandleClipOptions& each : {options, puffs}) {
    const auto truth = simulate_candle(each, {});
    ASSERT_FALSE(truth);
    EXPECT_THAT(truth.error().message, HasSubstr("not added to a recorded wind; leave them out"));
  }
}

TEST(CandleClip, MissesTheOutlineWhileTheFlameIsOut) {
  CandleClipOptions options = short_clip();
  options.seconds = 2.2;
  options.wind.kind = WindKind::kCalm;
  options.wind.blow_out_at = 0.1;
  options.wind.relight_after = 1.2;
  const Clip clip = shoot(options);
  const std::vector<double>& lit = channel(clip.truth, "lit").samples;
  const std::vector<double>& tip = channel(clip.truth, "tip.y").samples;
  EXPECT_EQ(lit.front(), 1);
  EXPECT_EQ(lit[66], 0);
  EXPECT_TRUE(std::isnan(tip[66]));
  EXPECT_EQ(lit.back(), 1);
  EXPECT_GT(tip.back(), 20);
}

TEST(CandleClip, EndsWithTheErrorOfWhatItGoesTo) {
  CandleClipOutputs outputs;
  outputs.on_frame = [](const CandleFrame& frame) -> Result<void> {
    if (frame.index == 3) return Error{"the disk is full"};
    return {};
  };
  const auto truth = simulate_candle(short_clip(), outputs);
  ASSERT_FALSE(truth);
  EXPECT_EQ(truth.error().message, "the disk is full");
}

TEST(CandleClip, SaysWhichOptionIsWrong) {
  CandleClipOptions options = short_clip();
  options.seconds = 0;
  EXPECT_THAT(simulate_candle(options, {}).error().message, HasSubstr("seconds"));
  options = short_clip();
  options.camera.noise = -1;
  EXPECT_THAT(simulate_candle(options, {}).error().message, HasSubstr("noise"));
}

}  // namespace
}  // namespace wisp::candle_clip_test
