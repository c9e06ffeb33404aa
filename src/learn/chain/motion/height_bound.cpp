#include "learn/chain/motion/height_bound.hpp"

#include <algorithm>
#include <cmath>

namespace wisp::chain {
namespace {

constexpr std::size_t kParts = 16;  // short windows of the longest stretch; a long one is four
constexpr double kMinSegments = 8;  // of a long window: in fewer, what wanders slowly has no time to
// Of the variance from one to the other. Of random walks one in a hundred grows less, and of what returns to a mean
// within a ninetieth of the recording none in three hundred more (both simulated).
constexpr double kMaxGrowth = 1.7;

// The mean variance of heights within windows of so many rows, side by side.
double spread_within(const Motion& motion, std::size_t rows) {
  double variance = 0, windows = 0;
  for (const MotionPiece& piece : motion.pieces) {
    for (std::size_t begin = 0; begin + rows <= piece.rows(); begin += rows, ++windows) {
      double sum = 0, square = 0;
      for (std::size_t row = begin; row < begin + rows; ++row) {
        const double z = piece.position[row][2] - piece.position[begin][2];
        sum += z;
        square += z * z;
      }
      const auto count = static_cast<double>(rows);
      variance += square / count - sum / count * (sum / count);
    }
  }
  return variance / windows;
}

}  // namespace

bool height_is_bounded(const Motion& motion, std::span<const Segment> segments) {
  double steps = 0;
  for (const Segment& one : segments) steps += one.steps;
  std::size_t longest = 0;
  for (const MotionPiece& piece : motion.pieces) longest = std::max(longest, piece.rows());
  const std::size_t window = longest / kParts;
  if (4.0 * static_cast<double>(window) * static_cast<double>(segments.size()) < kMinSegments * steps) return false;
  return spread_within(motion, 4 * window) < kMaxGrowth * spread_within(motion, window);
}

}  // namespace wisp::chain
