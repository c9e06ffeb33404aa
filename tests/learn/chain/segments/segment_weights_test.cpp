#include "learn/chain/segments/segment_weights.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <random>

namespace wisp::chain::segment_weights_test {
namespace {

struct Watched {
  Motion motion;
  std::vector<Segment> segments;

  // A recording of so many rows with events at these rows.
  void add(std::size_t rows, const std::vector<double>& events) {
    MotionPiece piece;
    piece.position.resize(rows);
    for (std::size_t k = 0; k + 1 < events.size(); ++k) {
      segments.push_back({motion.pieces.size(), events[k], events[k + 1], static_cast<int>(events[k + 1] - events[k])});
    }
    motion.pieces.push_back(piece);
  }
};

TEST(SegmentWeights, WhatWasCutOffIsHandedOnToAllThatLastedLonger) {
  Watched watched;
  watched.add(21, {0, 5, 15});  // and one that lasted more than 5 rows
  watched.add(26, {0, 10});     // and one that lasted more than 15
  // Began: 5, more than 5, 10, 10, more than 15. The second is handed on to three, of which two are whole.
  const auto weight = segment_weights(watched.motion, watched.segments);
  ASSERT_EQ(weight.size(), 3U);
  EXPECT_NEAR(weight[1] / weight[0], 4.0 / 3, 1e-12);
  EXPECT_NEAR(weight[2] / weight[0], 4.0 / 3, 1e-12);
  EXPECT_NEAR(weight[0] + weight[1] + weight[2], 3, 1e-12);
}

// Segments of 5 or of 30 rows, as many of each, in recordings of 40 to 59 rows.
TEST(SegmentWeights, ShortRecordingsTellTheMeanLength) {
  std::mt19937_64 random(3);
  Watched watched;
  for (int recording = 0; recording < 2000; ++recording) {
    const std::size_t rows = 40 + random() % 20;
    std::vector<double> events{0};
    for (;;) {
      const double next = events.back() + (random() % 2 == 0 ? 5 : 30);
      if (next > static_cast<double>(rows - 1)) break;
      events.push_back(next);
    }
    watched.add(rows, events);
  }
  const auto weight = segment_weights(watched.motion, watched.segments);
  double seen = 0, mean = 0;
  for (std::size_t k = 0; k < weight.size(); ++k) {
    const double rows = watched.segments[k].end - watched.segments[k].begin;
    seen += rows / static_cast<double>(weight.size());
    mean += weight[k] * rows / static_cast<double>(weight.size());
  }
  EXPECT_LT(seen, 14);         // as many long ones as short ones began: 17.5
  EXPECT_NEAR(mean, 17.5, 1);  // 0.2 is its standard error
}

TEST(SegmentWeights, InLongRecordingsEachStandsForItself) {
  Watched watched;
  for (std::size_t recording = 0; recording < 20; ++recording) {
    std::vector<double> events;
    for (std::size_t k = 0; k < 150; ++k) events.push_back(static_cast<double>(8 * k + (k % 3 + recording) % 4));
    watched.add(1203, events);
  }
  for (double one : segment_weights(watched.motion, watched.segments)) EXPECT_EQ(one, 1);
}

}  // namespace
}  // namespace wisp::chain::segment_weights_test
