#pragma once
// Modes of a chain realised as splines: what the segments of a mode have in common, in how many ways they differ, and
// for each segment how far it went in each of those ways. A file holds that instead of their rows, which are made of it
// when it is read.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

struct ChainSegments;

/// Cubic B-splines with uniform knots over the time of a segment, from 0 at its start to 1 at
/// its end. All control points are in the numbers in which rows are stored.
struct ModeSplines {
  int control_points = 0;           ///< 4 … 32
  int components = 0;               ///< ways to differ from the mean, 0 … 64
  std::vector<float> mean;          ///< modes × control points × channels
  std::vector<float> component;     ///< modes × components × control points × channels: what a score of 1 adds
  std::vector<std::int16_t> score;  ///< segments × components
};

/// More rows than this a file can't ask for.
inline constexpr std::size_t kMaxSplineRows = 1'000'000;

/// Rows of all segments as ChainSegments has them: the mean and the components by their scores, at the times of the
/// steps; quaternions are made unit. The same numbers on every machine.
///
/// Precondition: check(splines, segments, modes, channels) passes.
std::vector<std::int16_t> rows_of(const ModeSplines& splines, const ChainSegments& segments, int channels);

/// Errors: shapes, ranges, numbers that are not finite, more rows than kMaxSplineRows; modes, lengths or row scales of
/// the segments of which no rows can be made.
Result<void> check(const ModeSplines& splines, const ChainSegments& segments, int modes, int channels);

}  // namespace wisp
