#pragma once
// What an eye follows of something that falls, row by row, and windows of it for the measures of fidelity.
//
// docs/explanation/fidelity.md: a window spans at least two mean segments, so that every window has a join in it.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "learn/chain/motion/motion.hpp"
#include "learn/chain/motion/segmentation.hpp"
#include "learn/fidelity/fidelity_distance.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::chain {

/// Descent speed, horizontal speed, heading change and segment length, and for poses tilt and spin: one row a row of
/// the piece, from its first event to its last.
struct MotionSeries {
  std::size_t columns = 0;
  std::vector<double> values;  ///< rows × columns, row-major
  std::size_t rows() const { return columns == 0 ? 0 : values.size() / columns; }
};

/// One series a piece that has two events; the others have no rows.
std::vector<MotionSeries> motion_series(const Motion& motion, std::span<const Segment> segments);

/// Windows of `rows` rows, end to end; the features are mean, standard deviation, least and most of every column. A
/// block is a piece.
///
/// Precondition: rows >= 2.
FeatureWindows series_windows(std::span<const MotionSeries> series, std::size_t rows);

/// The same rows in random order, each piece by itself: the same moments without their order.
std::vector<MotionSeries> shuffled(std::span<const MotionSeries> series, std::uint64_t seed);

}  // namespace wisp::chain
