#include "wisp/capture/media/sound.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>

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

std::string little(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i));
  return text;
}

std::string chunk(const std::string& id, const std::string& body) { return id + little(body.size(), 4) + body; }

std::string format_chunk(unsigned tag, unsigned bits) {
  const unsigned frame = bits / 8;
  return chunk("fmt ", little(tag, 2) + little(1, 2) + little(8000, 4) + little(8000 * frame, 4) + little(frame, 2) +
                           little(bits, 2));
}

std::string riff(const std::string& chunks) { return "RIFF" + little(4 + chunks.size(), 4) + "WAVE" + chunks; }

std::string wav_of(unsigned tag, unsigned bits, const std::vector<std::uint64_t>& samples) {
  std::string data;
  for (const std::uint64_t sample : samples) data += little(sample, static_cast<int>(bits / 8));
  return riff(format_chunk(tag, bits) + chunk("data", data));
}

Result<std::optional<support::Sound>> sound_of(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
  return read_sound(path);
}

TEST(Sound, OfAWavOfAnyCodingIsExact) {
  ScratchFolder folder("codings");
  const std::string sizes = chunk("ds64", little(0, 8) + little(4, 8) + little(2, 8) + little(0, 4));
  const std::string half_and_quarter = little(16384, 2) + little(8192, 2);
  const struct {
    std::string bytes;
    std::vector<float> samples;
  } wavs[] = {
      {wav_of(1, 8, {0x80, 0xff, 0x01, 0x80}), {0, 127.0F / 128, -127.0F / 128, 0}},
      {wav_of(1, 16, {0x8000, 0x7fff, 1}), {-1, 32767.0F / 32768, 1.0F / 32768}},
      {wav_of(1, 24, {0x800000, 0xffffff, 1, 0}), {-1, -1.0F / 8388608, 1.0F / 8388608, 0}},
      {wav_of(1, 32, {0x80000000U, 0x40000000}), {-1, 0.5F}},
      {wav_of(3, 32, {std::bit_cast<std::uint32_t>(1.5F)}), {1.5F}},
      {wav_of(3, 64, {std::bit_cast<std::uint64_t>(-0.25)}), {-0.25F}},
      {riff(chunk("LIST", "even") + format_chunk(1, 16) + chunk("data", half_and_quarter) + chunk("id3 ", "tail")),
       {0.5F, 0.25F}},
      {"RIFF" + little(0xffffffffU, 4) + "WAVE" + format_chunk(1, 16) + "data" + little(0xffffffffU, 4) +
           half_and_quarter,
       {0.5F, 0.25F}},
      {"RF64" + little(0xffffffffU, 4) + "WAVE" + sizes + format_chunk(1, 16) + "data" + little(0xffffffffU, 4) +
           half_and_quarter + "tail",
       {0.5F, 0.25F}},
  };
  for (const auto& wav : wavs) {
    const auto sound = sound_of(folder / "a.wav", wav.bytes);
    ASSERT_TRUE(sound && *sound) << wav.bytes.size();
    EXPECT_EQ((*sound)->samples, wav.samples);
  }
}

TEST(Sound, EveryCutOfAWavIsReadOrRefusedAndNeverMore) {
  ScratchFolder folder("cuts");
  const std::string whole = wav_of(1, 24, {1, 2, 3, 4, 5, 6});
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const auto sound = sound_of(folder / "cut.wav", whole.substr(0, length));
    if (!sound) {
      EXPECT_THAT(sound.error().message, HasSubstr("cut.wav"));
    } else if (*sound) {
      EXPECT_LE((*sound)->samples.size(), 6u);
    }
  }
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
