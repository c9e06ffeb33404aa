#include "learn/chain/segments/join_jumps.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace wisp::chain {
namespace {

constexpr double kUsualShare = 0.99;
constexpr int kRows = 3;             // a mismatch of rates shows in the first, its fading in the next ones
constexpr double kMinHalfCos = 0.2;  // as the bank holds rotations
constexpr double kMinSpeed = 1e-12;

Triple plus(const Triple& a, const Triple& b, double factor = 1) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}
Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Triple times(const Triple& a, double factor) { return {a[0] * factor, a[1] * factor, a[2] * factor}; }

// The turn about z that brings one orientation nearest to another.
double turn_between(const Quad& from, const Quad& to) {
  const double w = to[0] * from[0] + to[1] * from[1] + to[2] * from[2] + to[3] * from[3];
  const double z = to[3] * from[0] - to[0] * from[3] + to[2] * from[1] - to[1] * from[2];
  return 2 * std::atan2(z, w);
}
double turn_between(const Triple& from, const Triple& to) {
  const double along = to[0] * from[0] + to[1] * from[1], across = to[1] * from[0] - to[0] * from[1];
  return std::hypot(along, across) > kMinSpeed ? std::atan2(across, along) : 0;
}

// Rotations away from an orientation as Gibbs vectors, on the world's side.
Triple gibbs_between(const Quad& from, const Quad& to) {
  const Triple from_axis{from[1], from[2], from[3]}, to_axis{to[1], to[2], to[3]};
  const double w = to[0] * from[0] + dot(to_axis, from_axis);
  const Triple v = plus(plus(times(to_axis, from[0]), from_axis, -to[0]), cross(to_axis, from_axis), -1);
  return times(v, (w < 0 ? -1 : 1) / std::max(std::abs(w), kMinHalfCos));
}
Quad rotated(const Triple& g, const Quad& q) {
  const Triple axis{q[1], q[2], q[3]};
  const Triple v = plus(plus(axis, g, q[0]), cross(g, axis));
  const double w = q[0] - dot(g, axis), size = std::sqrt(w * w + dot(v, v));
  return {w / size, v[0] / size, v[1] / size, v[2] / size};
}
Triple rotated(const Triple& g, const Triple& v) {
  const Triple once = cross(g, v);
  return plus(v, plus(once, cross(g, once)), 2 / (1 + dot(g, g)));
}
Triple gibbs_rate(const Triple& g, const Triple& spin) {
  return times(plus(plus(spin, cross(spin, g)), g, dot(g, spin)), 0.5);
}

// The nearer sign of a quaternion.
Quad signed_as(const Quad& near, Quad q) {
  double along = 0;
  for (std::size_t k = 0; k < 4; ++k) along += near[k] * q[k];
  if (along < 0) {
    for (double& x : q) x = -x;
  }
  return q;
}

template <std::size_t kSize>
double second_difference(const std::array<double, kSize>& a, const std::array<double, kSize>& b,
                         const std::array<double, kSize>& c) {
  double square = 0;
  for (std::size_t k = 0; k < kSize; ++k) square += (c[k] - 2 * b[k] + a[k]) * (c[k] - 2 * b[k] + a[k]);
  return std::sqrt(square);
}

double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0;
  const auto at = static_cast<long>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

}  // namespace

Jump jump_at(const MotionPiece& piece, std::size_t row) {
  Jump jump{second_difference(piece.position[row - 2], piece.position[row - 1], piece.position[row]), 0};
  if (!piece.orientation.empty()) {
    jump.rotation = second_difference(piece.orientation[row - 2], piece.orientation[row - 1], piece.orientation[row]);
  }
  return jump;
}

Jump usual_jump(const Motion& motion, double share) {
  std::vector<double> position, rotation;
  for (const MotionPiece& piece : motion.pieces) {
    for (std::size_t row = 2; row < piece.rows(); ++row) {
      const Jump jump = jump_at(piece, row);
      position.push_back(jump.position);
      rotation.push_back(jump.rotation);
    }
  }
  return {quantile(position, share), quantile(rotation, share)};
}

JoinForesight::JoinForesight(const Motion& motion, std::span<const Segment> segments, bool heading_free,
                             const ChainBlend& blend)
    : motion_(motion),
      segments_(segments),
      heading_free_(heading_free),
      blend_(blend),
      usual_(usual_jump(motion, kUsualShare)) {}

double JoinForesight::jump(std::size_t from, std::size_t to) const {
  const MotionPiece &old = motion_.pieces[segments_[from].piece], &fresh = motion_.pieces[segments_[to].piece];
  const auto end = static_cast<std::size_t>(segments_[from].end), begin = static_cast<std::size_t>(segments_[to].begin);
  if (end == 0) return 0;
  const bool turns = motion_.has_orientation;
  const double length = std::min(blend_.share * segments_[to].steps, blend_.longest_steps);
  const bool fades = length > 1;
  const double seconds = length / motion_.rate_hz;
  double turn = 0;
  if (heading_free_) {
    turn = turns ? turn_between(fresh.orientation[begin], old.orientation[end])
                 : turn_between(fresh.velocity[begin], old.velocity[end]);
  }
  const Triple slip = plus(old.velocity[end], turned_about_z(fresh.velocity[begin], turn), -1);
  Triple lean{}, lean_slip{};
  if (turns) {
    lean = gibbs_between(turned_about_z(fresh.orientation[begin], turn), old.orientation[end]);
    const Triple spin = rotated(lean, turned_about_z(fresh.spin[begin], turn));
    lean_slip = gibbs_rate(lean, plus(old.spin[end], spin, -1));
  }
  std::array<Triple, kRows + 2> position{};
  std::array<Quad, kRows + 2> attitude{};
  for (std::size_t back : {1U, 0U}) {
    position[1 - back] = plus(old.position[end - back], old.position[end], -1);
    if (turns) attitude[1 - back] = old.orientation[end - back];
  }
  double greatest = 0;
  const std::size_t rows = std::min<std::size_t>(kRows, static_cast<std::size_t>(segments_[to].steps));
  for (std::size_t k = 1; k <= rows; ++k) {
    const double passed = fades ? std::min(1.0, static_cast<double>(k) / length) : 1, rest = 1 - passed;
    const double pull = passed * rest * rest, weight = rest * rest + 2 * pull;
    const Triple way = plus(fresh.position[begin + k], fresh.position[begin], -1);
    position[k + 1] = plus(turned_about_z(way, turn), slip, pull * seconds);
    greatest = std::max(greatest, second_difference(position[k - 1], position[k], position[k + 1]) / usual_.position);
    if (!turns) continue;
    const Triple g = plus(times(lean, weight), lean_slip, pull * seconds);
    attitude[k + 1] = signed_as(attitude[k], rotated(g, turned_about_z(fresh.orientation[begin + k], turn)));
    greatest = std::max(greatest, second_difference(attitude[k - 1], attitude[k], attitude[k + 1]) / usual_.rotation);
  }
  return greatest;
}

}  // namespace wisp::chain
