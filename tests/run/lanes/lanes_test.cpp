#include "run/lanes/lanes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>

namespace wisp::lanes_test {
namespace {

std::array<float, LiveNumbers::kLanes> settled(float value) {
  std::array<float, LiveNumbers::kLanes> lanes{};
  store(settle(all<Reals<LiveNumbers>>(value)), lanes.data());
  return lanes;
}

TEST(Lanes, WhatIsNearlyZeroIsZeroOfNoSign) {
  for (float small : {-0.0f, 1e-21f, -1e-21f, 1e-40f}) {
    for (float lane : settled(small)) EXPECT_EQ(std::bit_cast<std::uint32_t>(lane), 0U) << small;
  }
  for (float seen : {kMinState, -kMinState, 0.5f, -1e9f}) {
    for (float lane : settled(seen)) EXPECT_EQ(lane, seen);
  }
}

}  // namespace
}  // namespace wisp::lanes_test
