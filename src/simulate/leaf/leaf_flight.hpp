#pragma once
// A rigid leaf falling through air: a thin elliptic plate under quasi-steady aerodynamics, 13 state variables; the wind
// around it; its fall, solved by Runge-Kutta steps of fourth order (docs/studies/leaf.md compares step lengths).
//
// Source: the thin plate of A. Andersen, U. Pesavento & Z. J. Wang, Unsteady aerodynamics of fluttering and tumbling
// plates, J. Fluid Mech. 541 (2005), extended to three dimensions: added mass and inertia of an ellipsoid (H. Lamb,
// Hydrodynamics, 1932, § 114), lift by translation and by rotation, drag, and damping of rotation.
// docs/explanation/leaf.md has the equations.

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/simulate/leaf_drops.hpp"

namespace wisp::leaf {

using Vec = std::array<double, 3>;
using Quaternion = std::array<double, 4>;  // w first

inline Vec operator+(const Vec& a, const Vec& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vec operator-(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
/// Elementwise product.
inline Vec operator*(const Vec& a, const Vec& b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }
inline Vec operator*(double s, const Vec& a) { return {s * a[0], s * a[1], s * a[2]}; }

inline double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A rotation matrix by rows.
struct Rotation {
  Vec row_x, row_y, row_z;

  Vec operator()(const Vec& v) const { return {dot(row_x, v), dot(row_y, v), dot(row_z, v)}; }
  Vec back(const Vec& v) const { return v[0] * row_x + v[1] * row_y + v[2] * row_z; }
};

/// Returns the rotation of a quaternion of any nonzero norm.
inline Rotation rotation_of(const Quaternion& q) {
  const auto& [w, x, y, z] = q;
  const double ww = w * w, xx = x * x, yy = y * y, zz = z * z, two = 2 / (ww + xx + yy + zz);
  const double xy = x * y, xz = x * z, yz = y * z, wx = w * x, wy = w * y, wz = w * z;
  return {{1 - two * (yy + zz), two * (xy - wz), two * (xz + wy)},
          {two * (xy + wz), 1 - two * (xx + zz), two * (yz - wx)},
          {two * (xz - wy), two * (yz + wx), 1 - two * (xx + yy)}};
}

/// Returns ½ q ⊗ (0, ω): the time derivative of the attitude.
inline Quaternion turning(const Quaternion& q, const Vec& spin) {
  const auto& [w, x, y, z] = q;
  const Vec h = 0.5 * spin;
  return {-(x * h[0]) - y * h[1] - z * h[2], w * h[0] + y * h[2] - z * h[1], w * h[1] + z * h[0] - x * h[2],
          w * h[2] + x * h[1] - y * h[0]};
}

/// Returns the quaternion normalised to length 1. Precondition: not zero.
inline Quaternion normalised(const Quaternion& q) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return {q[0] / length, q[1] / length, q[2] / length, q[3] / length};
}

}  // namespace wisp::leaf

namespace wisp {

/// Checks the leaf's fields. Errors: a field outside its range.
Result<void> check(const Leaf& leaf);

/// Pose and motion of the leaf. Body axes: x along the midrib, y across it, z normal to the leaf's upper side.
struct LeafState {
  std::array<double, 4> attitude{1, 0, 0, 0};  ///< unit quaternion, w first, leaf to world
  std::array<double, 3> position{};            ///< metres, z up
  std::array<double, 3> velocity{};            ///< velocity of the centre, in body axes, m/s
  std::array<double, 3> spin{};                ///< angular velocity in body axes, rad/s
};

/// Inertia of the leaf and added inertia of the air, about the body axes.
struct LeafInertia {
  double mass = 0;                       ///< kg
  std::array<double, 3> moment{};        ///< kg m²
  std::array<double, 3> added_mass{};    ///< kg
  std::array<double, 3> added_moment{};  ///< kg m²
};

/// Precondition: check(leaf) succeeds.
LeafInertia leaf_inertia(const Leaf& leaf);

/// Returns the energy of leaf and added mass, kinetic and potential above z = 0, joules; in still air it never grows.
double leaf_energy(const Leaf& leaf, const LeafState& state);

/// Returns the velocity in world axes, m/s.
std::array<double, 3> leaf_world_velocity(const LeafState& state);

/// Returns the normal of the leaf's upper side in world axes.
std::array<double, 3> leaf_normal(const LeafState& state);

/// The wind at a leaf, in world axes.
struct WindSample {
  std::array<double, 3> velocity{};  ///< m/s
  std::array<double, 3> change{};    ///< rate of change at the moving leaf, m/s²
};

/// One gust, whose front passes the origin at `start`.
struct Gust {
  double start = 0;                  ///< seconds
  double seconds = 0;                ///< duration from start to end, edges included
  double edge = 0;                   ///< duration of each edge, seconds, at most seconds / 2
  std::array<double, 3> velocity{};  ///< velocity at the maximum, m/s
  std::array<double, 3> slowness{};  ///< s/m: direction of travel / travel speed
};

/// The wind at any position and time.
class LeafWind {
 public:
  /// Creates still air.
  LeafWind() = default;

  static constexpr double kRestSeconds = 1.5;  ///< typical calm between gusts, seconds

  /// Creates a sequence of random gusts for `seconds`, each in a random horizontal direction.
  static LeafWind gusty(std::uint64_t seed, double seconds);

  /// Creates the sum of given gusts. Precondition: seconds > 0 and 0 < edge <= seconds / 2 for each.
  static LeafWind of_gusts(std::vector<Gust> gusts);

  /// Creates a measured wind. Precondition: rate_hz > 0, all rows finite.
  static LeafWind of_track(MeasuredWind track);

  /// Returns the wind at `place` and its rate of change along the path of a leaf with velocity `moving` (world axes).
  WindSample at(const std::array<double, 3>& place, const std::array<double, 3>& moving, double seconds) const;

  /// Returns whether there is no wind at any position and time.
  bool calm() const { return gusts_.empty() && track_.rows.empty(); }

  /// Returns the greatest speed of gusts and measured rows, m/s.
  double fastest() const;

  const std::vector<Gust>& gusts() const { return gusts_; }

 private:
  std::vector<Gust> gusts_;
  MeasuredWind track_;
};

}  // namespace wisp

namespace wisp::leaf {

/// Constants of a leaf, with products precomputed.
struct Constants {
  Vec carried{};       // added mass
  Vec inverse_mass{};  // 1 / (m + added mass)
  Vec moment{};        // including added inertia
  Vec inverse_moment{};
  double mass = 0;
  double weight = 0;                 // m g
  double lift = 0;                   // ρ S C_T
  double drag = 0, drag_normal = 0;  // ½ ρ S C_D0 and ½ ρ S (C_D90 − C_D0)
  double swirl_x = 0, swirl_y = 0;   // coefficient of rotational lift about each axis
  Vec damping_spin{}, damping_speed{};
};

/// Precondition: check(leaf) succeeds.
Constants constants_of(const Leaf& leaf);

/// Returns the time derivative of a state, in the same layout. The attitude may have any nonzero norm.
LeafState rate_of(const Constants& c, const LeafState& s, const WindSample& wind);

}  // namespace wisp::leaf

namespace wisp {

/// A leaf in the air, advanced by advance(); equal calls give equal bits.
class LeafFlight {
 public:
  /// Starts a leaf in a state, at time 0; the wind is kept by reference and must outlive the flight. Steps are
  /// `longest_step` seconds at most, 1e-6 … 0.05, and shorter for narrow or light leaves and in strong wind, in inverse
  /// proportion to its speed. Errors: leaf or step out of range, a state that is not finite, an attitude of norm 0.
  static Result<LeafFlight> begin(const Leaf& leaf, const LeafWind& wind, const LeafState& state,
                                  double longest_step = 1.0 / 60);

  /// Advances by `seconds` > 0, in equal steps. Errors: the leaf's state is no longer finite.
  Result<void> advance(double seconds);

  const LeafState& state() const { return state_; }
  double seconds() const { return seconds_; }

  /// Returns the times of the stalls so far (zeros of the velocity along body y, linear between steps), in seconds.
  const std::vector<double>& stalls() const { return stalls_; }

 private:
  LeafState rate(const LeafState& s, double at) const;
  void step(double h);

  leaf::Constants constants_;
  const LeafWind* wind_ = nullptr;
  double longest_step_ = 0;
  LeafState state_;
  double seconds_ = 0;
  std::vector<double> stalls_;
};

}  // namespace wisp
