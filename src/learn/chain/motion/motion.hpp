#pragma once
// Reads recordings as motion: positions, orientations and their rates, one piece per uninterrupted stretch.

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

inline constexpr const char* kPositions[] = {"pos.x", "pos.y", "pos.z"};

/// Returns "SOURCE: row N" for errors, counted from 1.
std::string row_name(const Recording& recording, std::size_t row);

inline double dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline double length_of(const Triple& v) { return std::sqrt(dot(v, v)); }

/// Whether two rates agree within 0.1 %: clocks and rounded periods may differ by that much.
inline bool same_rate(double a, double b) { return std::abs(a - b) <= 1e-3 * b; }

/// Consecutive rows of one episode of one recording, without missing samples.
struct MotionPiece {
  std::size_t recording = 0;  ///< index of the recording
  std::size_t first_row = 0;  ///< index of the piece's first row in the recording
  std::vector<Triple> position;
  std::vector<Triple> velocity;   ///< units per second, world axes
  std::vector<Quad> orientation;  ///< unit quaternions, w first, body to world, continuous sign; or empty
  std::vector<Triple> spin;       ///< radians a second, world axes; empty without orientation

  std::size_t rows() const { return position.size(); }
};

struct Motion {
  bool has_orientation = false;
  double rate_hz = 0;
  std::vector<MotionPiece> pieces;
  std::vector<std::string> warnings;
};

/// Reads the channels pos.x, pos.y, pos.z and, if present, q.w, q.x, q.y, q.z. Velocities are slopes of a parabola
/// fitted to `smooth_rows` rows (odd; below 3: finite differences of fourth order, for data without noise). Quaternions
/// are normalised, with a warning where they deviate by more than rounding; sign flips are undone. Pieces shorter than
/// 8 rows are left out. Errors: no recordings, a missing channel, orientation in only some recordings, rates that
/// differ, a quaternion more than 1 % from unit length (with its row), a time channel (t, t_s or time) with steps other
/// than the recording's, a jump of the position, no piece long enough.
Result<Motion> motion_of(std::span<const Recording> recordings, int smooth_rows = 0);

/// Interpolates by a Catmull–Rom cubic over the four rows around. Precondition: 0 <= row <= rows − 1, values not empty.
Triple at_row(std::span<const Triple> values, double row);
Quad at_row(std::span<const Quad> values, double row);  ///< normalised

/// Rotates a vector from world axes to the body's axes.
Triple in_body_axes(const Quad& orientation, const Triple& vector);

/// Rotates a vector from the body's axes to world axes.
Triple in_world_axes(const Quad& orientation, const Triple& vector);

/// The orientation rotated about z by an angle in radians.
Quad turned_about_z(const Quad& orientation, double angle);
Triple turned_about_z(const Triple& vector, double angle);

}  // namespace wisp::chain
