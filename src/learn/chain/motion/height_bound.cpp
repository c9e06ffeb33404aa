#include "learn/chain/motion/height_bound.hpp"

#include <algorithm>
#include <cmath>

namespace wisp::chain {
namespace {

constexpr double kShort = 8, kLong = 32;  // windows, segments
constexpr double kMaxGrowth = 2;          // of the variance from one to the other: midway, as ratios, from 1 to 4

// The mean variance of heights within windows of so many rows, side by side; and how many there are.
struct Spread {
  double variance = 0;
  std::size_t windows = 0;
};

Spread spread_within(const Motion& motion, std::size_t rows) {
  Spread out;
  for (const MotionPiece& piece : motion.pieces) {
    for (std::size_t begin = 0; begin + rows <= piece.rows(); begin += rows) {
      double sum = 0, square = 0;
      for (std::size_t row = begin; row < begin + rows; ++row) {
        const double z = piece.position[row][2] - piece.position[begin][2];
        sum += z;
        square += z * z;
      }
      const auto count = static_cast<double>(rows);
      out.variance += square / count - sum / count * (sum / count);
      ++out.windows;
    }
  }
  out.variance /= static_cast<double>(std::max<std::size_t>(1, out.windows));
  return out;
}

}  // namespace

bool height_is_bounded(const Motion& motion, std::span<const Segment> segments) {
  double steps = 0;
  for (const Segment& one : segments) steps += one.steps;
  const double usual = steps / static_cast<double>(segments.size());
  const auto rows = [&](double count) { return static_cast<std::size_t>(std::ceil(count * usual)); };
  const Spread far = spread_within(motion, rows(kLong));
  return far.windows > 0 && far.variance < kMaxGrowth * spread_within(motion, rows(kShort)).variance;
}

}  // namespace wisp::chain
