// The same bits everywhere: with every compiler, at every level of optimisation, with denormals flushed or not.

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <vector>

#include "wisp/sound/wind_level.hpp"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace wisp::wind_bits_test {
namespace {

/// Four seconds made of integers only: a soft hiss, gusts of low noise, pulses like a voice's, and nothing at all.
std::vector<std::int16_t> made_sound(int rate_hz) {
  std::vector<std::int16_t> sound;
  std::uint32_t state = 12345;
  std::int32_t low = 0;
  std::int32_t ring = 0;
  for (int i = 0; i < 4 * rate_hz; ++i) {
    state = state * 1664525U + 1013904223U;
    const auto noise = static_cast<std::int32_t>(state >> 16) - 32768;
    low += (noise - low) / 16;
    if (i % (rate_hz / 110) == 0) ring = 12000;
    ring -= ring / 32;
    const int tenth = 10 * i / rate_hz;
    std::int32_t x = noise / 1024;
    if (tenth >= 8 && tenth < 16) x += low;
    if (tenth >= 20 && tenth < 28) x += ring;
    if (tenth >= 34) x = 0;
    sound.push_back(static_cast<std::int16_t>(x));
  }
  return sound;
}

std::uint64_t hash_of(int rate_hz, int channels) {
  auto wind = WindLevel::create({static_cast<double>(rate_hz), channels}, {.exponent = 0.6, .smoothing_seconds = 0.03});
  std::vector<WindFrame> frames(1000);
  const std::vector<std::int16_t> sound = made_sound(rate_hz);
  frames.resize(wind->feed(std::span<const std::int16_t>(sound), frames).frames);
  std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a
  const auto mix = [&hash](float x) { hash = (hash ^ std::bit_cast<std::uint32_t>(x)) * 1099511628211ULL; };
  for (const WindFrame& frame : frames) {
    for (const float x : {frame.rms, frame.rms_clean, frame.level, frame.speed, frame.wind, frame.confidence,
                          frame.background, frame.clipped}) {
      mix(x);
    }
  }
  return hash;
}

// Changing these hashes changes what everybody hears: say so in CHANGES.md.
TEST(WindBits, AreTheOnesOfEveryOtherMachine) {
  EXPECT_EQ(hash_of(8000, 1), 12171594888247749694ULL);
  EXPECT_EQ(hash_of(44100, 1), 4197826663205112833ULL);
  EXPECT_EQ(hash_of(48000, 2), 17747092957488820424ULL);
  EXPECT_EQ(hash_of(192000, 1), 12513041344710888125ULL);
}

TEST(WindBits, AreTheSameWhereDenormalsAreFlushed) {
#if defined(__SSE2__)
  const std::uint64_t expected = hash_of(44100, 1);
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | 0x8040U);  // flush to zero, denormals are zero
  const std::uint64_t flushed = hash_of(44100, 1);
  _mm_setcsr(before);
  EXPECT_EQ(flushed, expected);
#else
  GTEST_SKIP() << "this processor has no switch for denormals";
#endif
}

}  // namespace
}  // namespace wisp::wind_bits_test
