#include "wisp/capture/media/sound.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "capture/support/clip_files.hpp"
#include "capture/support/whole_sound.hpp"

namespace wisp::sound_test {
namespace {

using support::Plane;
using support::read_sound;
using support::ScratchFolder;
using testing::HasSubstr;

std::vector<std::int16_t> two_tones(int samples) {
  std::vector<std::int16_t> out;
  for (int k = 0; k < samples; ++k) {
    out.push_back(static_cast<std::int16_t>(std::lround(8000 * std::sin(0.05 * k))));
    out.push_back(static_cast<std::int16_t>(std::lround(-16384 * std::sin(0.02 * k))));
  }
  return out;
}

TEST(Sound, OfAWavIsExact) {
  ScratchFolder folder("wav");
  const auto samples = two_tones(5000);
  support::write_wav(folder / "tones.wav", 16000, 2, samples);
  const auto sound = read_sound(folder / "tones.wav");
  ASSERT_TRUE(sound) << sound.error().message;
  ASSERT_TRUE(sound->has_value());
  EXPECT_DOUBLE_EQ((*sound)->info.rate_hz, 16000);
  EXPECT_EQ((*sound)->info.channels, 2);
  EXPECT_EQ((*sound)->info.samples, 5000u);
  ASSERT_EQ((*sound)->samples.size(), samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    ASSERT_EQ((*sound)->samples[k], static_cast<float>(samples[k]) / 32768.0F);
  }
  EXPECT_NEAR((*sound)->info.peak, 0.5, 1e-3);
}

TEST(Sound, StreamsInBlocksAndStopsWhenAsked) {
  ScratchFolder folder("blocks");
  support::write_wav(folder / "tones.wav", 44100, 2, two_tones(200000));
  int blocks = 0;
  const auto info = stream_sound(folder / "tones.wav", [&](const SoundInfo& now, std::span<const float> samples) {
    EXPECT_EQ(now.channels, 2);
    EXPECT_LE(samples.size(), 2u * 44100);
    return ++blocks < 3;
  });
  ASSERT_TRUE(info);
  EXPECT_EQ(blocks, 3);
  EXPECT_LT((**info).samples, 200000u);
}

TEST(Sound, SilenceIsATrackThatIsSilent) {
  ScratchFolder folder("silence");
  const std::vector<std::int16_t> silence(4000);
  support::write_wav(folder / "silence.wav", 8000, 1, silence);
  const auto sound = read_sound(folder / "silence.wav");
  ASSERT_TRUE(sound->has_value());
  EXPECT_TRUE((*sound)->info.silent());
}

TEST(Sound, AClipWithoutATrackHasNone) {
  ScratchFolder folder("mute");
  { support::RawVideo(folder / "mute.y4m", 32, 24, 25).add(Plane(32, 24, 90)); }
  const auto sound = read_sound(folder / "mute.y4m");
  ASSERT_TRUE(sound) << sound.error().message;
  EXPECT_FALSE(sound->has_value());
}

TEST(Sound, WhatIsNoSoundIsAnError) {
  ScratchFolder folder("nosound");
  std::ofstream(folder / "text.wav") << "hush";
  EXPECT_THAT(read_sound(folder / "missing.wav").error().message, HasSubstr("no such file"));
  EXPECT_THAT(read_sound(folder / "text.wav").error().message, HasSubstr("text.wav"));
}

TEST(Sound, TheShakenFlamesTrackIsThereAndSilent) {
  const auto path = support::real_data() / "flame/flame_shaken_1080p60.mp4";
  WISP_NEEDS(path);
  const auto sound = read_sound(path);
  ASSERT_TRUE(sound->has_value());
  EXPECT_TRUE((*sound)->info.silent());
  EXPECT_NEAR(static_cast<double>((*sound)->info.samples) / (*sound)->info.rate_hz, 4.4, 0.2);
}

}  // namespace
}  // namespace wisp::sound_test
