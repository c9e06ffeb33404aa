#include "learn/chain/segments/segment_moments.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace wisp::chain::segment_moments_test {
namespace {

// A stretch without attitude that sets out in a direction and turns by so much a row.
MotionPiece turning(double heading, double turn) {
  MotionPiece piece;
  for (int row = 0; row <= 40; ++row) {
    const double way = heading + turn * (row - 20);
    piece.position.push_back({0.01 * row, 0, -0.01 * row});
    piece.velocity.push_back({std::cos(way), std::sin(way), -1 - 0.001 * row});
  }
  return piece;
}

SegmentMoments moments_of(const std::vector<MotionPiece>& pieces) {
  Motion motion{.rate_hz = 60, .pieces = pieces};
  std::vector<Segment> segments;
  for (std::size_t k = 0; k < pieces.size(); ++k) segments.push_back({k, 20, 30, 10});
  return segment_moments(motion, segments, true);
}

TEST(SegmentMoments, WithoutAttitudeSayToWhichSideABodyTurns) {
  const auto moments = moments_of({turning(0, 0.1), turning(0, -0.1)});
  EXPECT_GT(distance_of(moments.starts[0], moments.starts[1]), 1);
}

TEST(SegmentMoments, WithoutAttitudeDoNotSayWhereNorthWas) {
  const auto moments = moments_of({turning(0, 0.1), turning(2, 0.1), turning(0, -0.1)});
  EXPECT_NEAR(distance_of(moments.starts[0], moments.starts[1]), 0, 1e-12);
}

}  // namespace
}  // namespace wisp::chain::segment_moments_test
