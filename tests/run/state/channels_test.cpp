#include "run/state/channels.hpp"

#include <gtest/gtest.h>

namespace wisp::channels_test {
namespace {

TEST(Channels, UnitsArePowersOfTwoWhereARangeIsFarFromOne) {
  EXPECT_EQ(channel_scale(-0.5, 0.5), 1.0);
  EXPECT_EQ(channel_scale(0, 128), 1.0);
  EXPECT_EQ(channel_scale(0, 1.0 / 128), 1.0);
  EXPECT_EQ(channel_scale(-100, 100), 128.0);
  EXPECT_EQ(channel_scale(0, 0.001), 0x1p-10);
  EXPECT_EQ(channel_scale(3, 3), 1.0);
}

}  // namespace
}  // namespace wisp::channels_test
