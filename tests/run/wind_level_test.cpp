#include "wisp/run/wind_level.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace wisp {
namespace {

TEST(WindLevel, SilenceIsNoWind) {
  auto wind = WindLevel::create({48000, 1}, {});
  ASSERT_TRUE(wind);
  std::vector<WindFrame> frames(100);
  const WindFed fed = wind->feed(std::vector<float>(48000, 0.0F), frames);
  EXPECT_EQ(fed.samples, 48000U);
  ASSERT_EQ(fed.frames, 60U);
  for (std::size_t i = 0; i < fed.frames; ++i) {
    EXPECT_EQ(frames[i].rms, 0.0F);
    EXPECT_EQ(frames[i].speed, 0.0F);
    EXPECT_LT(frames[i].confidence, 0.01F);
  }
}

}  // namespace
}  // namespace wisp
