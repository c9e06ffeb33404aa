#include "learn/chain/modes/successor_modes.hpp"

#include <gtest/gtest.h>

namespace wisp::chain::successor_modes_test {
namespace {

// Forty segments of two modes: those of mode 0 begin near 0, those of mode 1 near 10. The first ends near 0, the second
// near 10, the third between them.
struct Recorded {
  SegmentMoments moments;
  std::vector<std::uint16_t> mode;
};

Recorded two_places() {
  Recorded out;
  for (int k = 0; k < 40; ++k) {
    const bool second = k % 2 == 1;
    out.mode.push_back(second ? 1 : 0);
    out.moments.starts.push_back({(second ? 10.0 : 0.0) + 0.01 * k});
    out.moments.ends.push_back({k == 0 ? 0.1 : k == 1 ? 10.1 : 5.195});
  }
  return out;
}

std::vector<double> one_each() { return std::vector<double>(40, 1.0); }

TEST(SuccessorModes, AModeThatBeginsWhereASegmentEndsIsFarLikelier) {
  const Recorded recorded = two_places();
  const std::size_t kept[] = {0, 1};
  const double transitions[] = {0.5, 0.5, 0.5, 0.5};
  const SuccessorModes successor_weights =
      successor_modes(recorded.moments, recorded.mode, one_each(), kept, transitions, 2);
  ASSERT_EQ(successor_weights.share.size(), 4U);
  EXPECT_EQ(successor_weights.share[0], 65535);
  EXPECT_LT(successor_weights.share[1], 65535 / 20);
  EXPECT_LT(successor_weights.share[2], 65535 / 20);
  EXPECT_EQ(successor_weights.share[3], 65535);
  EXPECT_GT(successor_weights.chances[0], 0.95);
  EXPECT_NEAR(successor_weights.chances[0] + successor_weights.chances[1], 1, 1e-12);
}

TEST(SuccessorModes, WhatTheHistoryFindsRareIsRaisedByWhatIsNearby) {
  const Recorded recorded = two_places();
  const std::size_t kept[] = {1};
  const double transitions[] = {0.5, 0.5, 0.95, 0.05};
  const SuccessorModes successor_weights =
      successor_modes(recorded.moments, recorded.mode, one_each(), kept, transitions, 2);
  EXPECT_EQ(successor_weights.share[1], 65535);
  EXPECT_GT(successor_weights.chances[1], 0.5);
}

TEST(SuccessorModes, WhatStandsForManyCountsAsMany) {
  const Recorded recorded = two_places();
  const std::size_t kept[] = {2};  // of the eight nearest, four are of each mode
  const double transitions[] = {0.5, 0.5, 0.5, 0.5};
  std::vector<double> weight = one_each();
  for (std::size_t k = 1; k < weight.size(); k += 2) weight[k] = 3;
  const SuccessorModes even = successor_modes(recorded.moments, recorded.mode, one_each(), kept, transitions, 2);
  const SuccessorModes successor_weights =
      successor_modes(recorded.moments, recorded.mode, weight, kept, transitions, 2);
  EXPECT_NEAR(even.chances[1], 0.5, 1e-12);
  EXPECT_NEAR(successor_weights.chances[1], 0.75, 0.01);
}

}  // namespace
}  // namespace wisp::chain::successor_modes_test
