#pragma once
// Recordings of something that moves, as motion: positions, orientations and their rates, one piece for every
// uninterrupted stretch.

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::chain {

using Triple = std::array<double, 3>;
using Quad = std::array<double, 4>;

inline double dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline double length_of(const Triple& v) { return std::sqrt(dot(v, v)); }

/// Consecutive rows of one episode of one recording, nothing missing.
struct MotionPiece {
  std::size_t recording = 0;  ///< index of the recording that it is from
  std::size_t first_row = 0;  ///< of that recording
  std::vector<Triple> position;
  std::vector<Triple> velocity;   ///< a second, world axes
  std::vector<Quad> orientation;  ///< unit, w first, body to world, sign continuous; empty without orientation
  std::vector<Triple> spin;       ///< radians a second, world axes; empty without orientation

  std::size_t rows() const { return position.size(); }
};

struct Motion {
  bool has_orientation = false;
  double rate_hz = 0;
  std::vector<MotionPiece> pieces;
  std::vector<std::string> warnings;
};

/// Reads the channels pos.x, pos.y, pos.z and, where there are, q.w, q.x, q.y, q.z. Velocities are derivatives of a
/// parabola through `smooth_rows` rows (odd; 0: differences of fourth order, for data without noise).
/// Quaternions are made unit, with a warning where they are more than a rounding away from it; flips of their sign are
/// undone. Pieces shorter than 8 rows are left out.
/// Errors: no recordings, a channel that is missing, orientation in one recording and not in another, rates that
/// differ, a quaternion more than 1 % from unit length (with its row), a time channel (t, t_s or time) whose steps are
/// not the recording's, nothing long enough.
Result<Motion> motion_of(std::span<const Recording> recordings, int smooth_rows = 0);

/// Between two rows, by a cubic through the four around.
///
/// Precondition: 0 <= row <= rows − 1, values not empty.
Triple at_row(std::span<const Triple> values, double row);
Quad at_row(std::span<const Quad> values, double row);  ///< of unit length

/// A vector of the world in the axes of a body.
Triple in_body_axes(const Quad& orientation, const Triple& vector);

/// A vector of the body in the axes of the world.
Triple in_world_axes(const Quad& orientation, const Triple& vector);

/// The orientation turned about z by an angle, radians.
Quad turned_about_z(const Quad& orientation, double angle);
Triple turned_about_z(const Triple& vector, double angle);

}  // namespace wisp::chain
