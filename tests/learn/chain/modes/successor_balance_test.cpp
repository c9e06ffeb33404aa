#include "learn/chain/modes/successor_balance.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace wisp::chain::successor_balance_test {
namespace {

// Twelve segments of one mode. Any may follow any; the first joins best, after everything.
Successors one_that_all_like() {
  Successors successors(12);
  for (std::uint16_t from = 0; from < 12; ++from) {
    for (std::uint16_t to = 0; to < 12; ++to) {
      const double around = 1 + 0.02 * ((to + 5 * from) % 12);
      if (to != from) successors[from].push_back({to == 0 ? 0.8 + 0.02 * from : around, to});
    }
  }
  return successors;
}

long times_followed(const std::vector<std::uint16_t>& follow, std::uint16_t segment) {
  return std::count(follow.begin(), follow.end(), segment);
}

TEST(FollowerBalance, WhatJoinsALittleBetterEverywhereGivesWayToOthers) {
  const std::vector<std::uint16_t> mode(12, 0);
  const std::vector<double> weight(12, 1.0);
  const std::vector<double> chances(12, 1.0);
  const auto follow = balanced_successors(one_that_all_like(), mode, weight, chances, 1, 3);
  ASSERT_EQ(follow.size(), 36U);
  EXPECT_LE(times_followed(follow, 0), 5);  // three each were even; eleven without prices
}

TEST(FollowerBalance, WhatStandsForManyIsPlayedOftener) {
  const std::vector<std::uint16_t> mode(12, 0);
  std::vector<double> weight(12, 1.0);
  const std::vector<double> chances(12, 1.0);
  weight[0] = 3;
  const auto follow = balanced_successors(one_that_all_like(), mode, weight, chances, 1, 3);
  EXPECT_GE(times_followed(follow, 0), 7);
}

TEST(FollowerBalance, WhatJoinsFarBetterStays) {
  const std::vector<std::uint16_t> mode(12, 0);
  const std::vector<double> weight(12, 1.0);
  const std::vector<double> chances(12, 1.0);
  Successors successors = one_that_all_like();
  for (auto& all : successors) {
    for (Successor& one : all) {
      if (one.segment == 0) one.misfit = 0;
    }
  }
  EXPECT_EQ(times_followed(balanced_successors(successors, mode, weight, chances, 1, 3), 0), 11);
}

TEST(FollowerBalance, FewerThanAskedForAreRepeated) {
  const std::vector<std::uint16_t> mode{0, 0};
  const double weight[] = {1, 1};
  const double chances[] = {1, 1};
  const Successors successors{{{0.5, 1}}, {{0.5, 0}}};
  EXPECT_EQ(balanced_successors(successors, mode, weight, chances, 1, 2), (std::vector<std::uint16_t>{1, 1, 0, 0}));
}

}  // namespace
}  // namespace wisp::chain::successor_balance_test
