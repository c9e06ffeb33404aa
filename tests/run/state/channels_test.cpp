#include "run/state/channels.hpp"

#include <gtest/gtest.h>

#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"

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

TEST(Channels, AMeanOfAPowerThatIsTooLargeIsRefused) {
  Model model = flame_model({.wind = InputShape::kEvenOdd});
  EXPECT_TRUE(Bank::create(model));
  std::get<ArxModel>(model.dynamics).input_mean[2] = 1e300;
  EXPECT_FALSE(Bank::create(model));
}

}  // namespace
}  // namespace wisp::channels_test
