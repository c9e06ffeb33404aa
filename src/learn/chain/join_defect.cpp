#include "learn/chain/join_defect.hpp"

#include <algorithm>
#include <cmath>

#include "base/statistics.hpp"

namespace wisp::chain {
namespace {

constexpr double kPercentile = 0.99;

struct Jumps {
  std::vector<double> position;
  std::vector<double> rotation;
};

template <std::size_t kSize>
double jump_of(std::span<const std::array<double, kSize>> values, std::size_t row) {
  double square = 0;
  for (std::size_t k = 0; k < kSize; ++k) {
    square += std::pow(values[row][k] - 2 * values[row - 1][k] + values[row - 2][k], 2);
  }
  return std::sqrt(square);
}

void add_jump(const MotionPiece& piece, std::size_t row, Jumps& jumps) {
  jumps.position.push_back(jump_of<3>(piece.position, row));
  if (!piece.orientation.empty()) jumps.rotation.push_back(jump_of<4>(piece.orientation, row));
}

JoinJumps compared(const std::vector<double>& joins, const std::vector<double>& all) {
  if (joins.empty() || all.empty()) return {};
  const double usual = quantile(all, kPercentile);
  const auto above = std::count_if(joins.begin(), joins.end(), [&](double jump) { return jump > usual; });
  return {quantile(joins, kPercentile) / usual, quantile(joins, 0.5) / usual,
          static_cast<double>(above) / static_cast<double>(joins.size())};
}

// Jumps at the join show in its row and in the one after.
Jumps jumps_at(const Motion& motion, std::span<const std::vector<std::size_t>> rows) {
  Jumps jumps;
  for (std::size_t k = 0; k < motion.pieces.size(); ++k) {
    for (std::size_t join : rows[k]) {
      for (std::size_t row = std::max<std::size_t>(2, join); row <= join + 1 && row < motion.pieces[k].rows(); ++row) {
        add_jump(motion.pieces[k], row, jumps);
      }
    }
  }
  return jumps;
}

}  // namespace

JoinDefect join_defect(const Motion& real, std::span<const Segment> segments, const Motion& made,
                       std::span<const std::vector<std::size_t>> joins) {
  Jumps all;
  for (const MotionPiece& piece : real.pieces) {
    for (std::size_t row = 2; row < piece.rows(); ++row) add_jump(piece, row, all);
  }
  std::vector<std::vector<std::size_t>> events(real.pieces.size());
  for (const Segment& one : segments) events[one.piece].push_back(static_cast<std::size_t>(std::lround(one.begin)));
  const Jumps joined = jumps_at(made, joins), natural = jumps_at(real, events);
  return {compared(joined.position, all.position), compared(joined.rotation, all.rotation),
          compared(natural.position, all.position), compared(natural.rotation, all.rotation)};
}

}  // namespace wisp::chain
