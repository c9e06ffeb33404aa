#include "draw/tone.hpp"

#include <gtest/gtest.h>

namespace wisp::drawing::tone_test {
namespace {

TEST(Tone, EveryCodeComesBackWhateverTheDither) {
  const Tone& tone = Tone::get();
  for (std::uint32_t code = 0; code < 256; ++code) {
    for (const float dither : {0.0F, 0.5F, 0.99F}) {
      EXPECT_EQ(dithered(tone.code(tone.linear(code)), dither), code) << "dither " << dither;
    }
  }
}

TEST(Tone, DitherRoundsUpAsOftenAsTheFractionSays) {
  int up = 0;
  constexpr int kSide = 128;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) up += dithered(40.3F, dither_at(x, y)) == 41 ? 1 : 0;
  }
  // The noise fills [0, 1) evenly; over 128 × 128 pixels it is within half a per cent.
  EXPECT_NEAR(static_cast<double>(up) / (kSide * kSide), 0.3, 0.02);
}

TEST(Tone, BlendingOpaqueReplacesAndTransparentKeeps) {
  std::uint32_t pixel = 0xFF203040U;
  blend(pixel, {1, 1, 1}, 0, 0.5F);
  EXPECT_EQ(pixel, 0xFF203040U);
  blend(pixel, {1, 0, 0}, 1, 0.5F);
  EXPECT_EQ(pixel, 0xFFFF0000U);
}

TEST(Tone, LightBeyondWhiteIsWhite) {
  std::uint32_t pixel = 0xFF000000U;
  blend(pixel, {50, 50, 50}, 1, 0.9F);
  EXPECT_EQ(pixel, 0xFFFFFFFFU);
}

}  // namespace
}  // namespace wisp::drawing::tone_test
