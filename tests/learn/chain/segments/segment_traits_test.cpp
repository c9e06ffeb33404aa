#include "learn/chain/segments/segment_traits.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <random>

namespace wisp::chain::segment_traits_test {
namespace {

struct Falls {
  Motion motion;
  std::vector<Segment> segments;
};

// Forty stretches of eight segments, each as long as it is told to be.
Falls falls(const std::function<int(int)>& rows_of) {
  Falls out;
  for (int stretch = 0; stretch < 40; ++stretch) {
    double row = 0;
    MotionPiece piece;
    for (int k = 0; k < 8; ++k) {
      const int rows = rows_of(stretch);
      out.segments.push_back({static_cast<std::size_t>(stretch), row, row + rows, rows});
      row += rows;
    }
    for (int k = 0; k <= static_cast<int>(row); ++k) piece.position.push_back({0.01 * k, 0, -0.02 * k});
    out.motion.pieces.push_back(piece);
  }
  return out;
}

TEST(SegmentTraits, AreThoseOfTheStretchAndNotOfTheSegment) {
  int count = 0;
  const Falls seen = falls([&](int stretch) { return (stretch < 20 ? 10 : 20) + (++count % 2 == 0 ? 2 : -2); });
  const auto traits = segment_traits(seen.motion, seen.segments);
  for (std::size_t k = 0; k < traits.size(); ++k) {
    EXPECT_EQ(traits[k], traits[k / 8 * 8]);
    // Ten rows apart, in deviations of two rows: of eight segments seven are free. Two hundredths may be chance.
    EXPECT_NEAR(traits[k][2], (k < 160 ? -2.5 : 2.5) * std::sqrt(7.0 / 8) * 0.978, 0.01);
  }
}

TEST(SegmentTraits, AreNoneWhereStretchesDifferByChance) {
  std::mt19937_64 random(2);
  std::uniform_int_distribution<int> any(5, 25);
  const Falls seen = falls([&](int) { return any(random); });
  for (const Traits& one : segment_traits(seen.motion, seen.segments)) EXPECT_NEAR(one[2], 0, 0.3);
}

}  // namespace
}  // namespace wisp::chain::segment_traits_test
