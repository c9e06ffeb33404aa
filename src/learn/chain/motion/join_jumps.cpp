#include "learn/chain/motion/join_jumps.hpp"

#include <array>
#include <cmath>

namespace wisp::chain {
namespace {

template <std::size_t kSize>
double second_difference(const std::array<double, kSize>& a, const std::array<double, kSize>& b,
                         const std::array<double, kSize>& c) {
  double square = 0;
  for (std::size_t k = 0; k < kSize; ++k) square += (c[k] - 2 * b[k] + a[k]) * (c[k] - 2 * b[k] + a[k]);
  return std::sqrt(square);
}

}  // namespace

Jump jump_at(const MotionPiece& piece, std::size_t row) {
  Jump jump{second_difference(piece.position[row - 2], piece.position[row - 1], piece.position[row]), 0};
  if (!piece.orientation.empty()) {
    jump.rotation = second_difference(piece.orientation[row - 2], piece.orientation[row - 1], piece.orientation[row]);
  }
  return jump;
}

}  // namespace wisp::chain
