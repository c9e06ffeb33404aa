#pragma once
// The leaf's equations of motion, over the number type. docs/explanation/leaf.md writes them out.

#include <cmath>

#include "simulate/leaf/leaf_vector.hpp"

namespace wisp::leaf {

/// Constants of a leaf, with products precomputed.
template <class Real>
struct Constants {
  Vec<Real> carried;       // added mass
  Vec<Real> inverse_mass;  // 1 / (m + added mass)
  Vec<Real> moment;        // with the air's
  Vec<Real> inverse_moment;
  Real mass{};
  Real weight{};               // m g
  Real lift{};                 // ρ S C_T
  Real drag{}, drag_normal{};  // ½ ρ S C_D0 and ½ ρ S (C_D90 − C_D0)
  Real swirl_x{}, swirl_y{};   // of the lift by rotation about each axis
  Vec<Real> damping_spin, damping_speed;
};

template <class Real>
struct State {
  Quaternion<Real> attitude;
  Vec<Real> position, velocity, spin;
};

/// Wind at the leaf, and its rate of change along the leaf's path; in the world's axes.
template <class Real>
struct Air {
  Vec<Real> wind, change;
};

/// Force of the relative air flow, in the body's axes. `v` is the leaf's velocity through the air.
template <class Real>
Vec<Real> air_force(const Constants<Real>& c, Vec<Real> v, Real speed, Vec<Real> spin) {
  const Real along2 = v.x * v.x + v.y * v.y, normal2 = v.z * v.z;
  // No force at rest, where the ratios below are undefined.
  const Real over = Real(1) / (speed + Real(1e-12));
  const Real lift = c.lift * v.z * over;
  const Real drag = c.drag * speed + c.drag_normal * normal2 * over;
  const Vec<Real> swirl{c.swirl_x * spin.x, c.swirl_y * spin.y, Real(0)};
  const Vec<Real> by_rotation{swirl.y * v.z, -(swirl.x * v.z), swirl.x * v.y - swirl.y * v.x};
  const Real in_plane = lift * v.z - drag;
  return Vec<Real>{in_plane * v.x, in_plane * v.y, -(lift * along2) - drag * v.z} + by_rotation;
}

template <class Real>
Vec<Real> air_torque(const Constants<Real>& c, Real speed, Vec<Real> spin) {
  using std::abs;
  const auto damp = [&](Real own, Real stream, Real rate) { return -(rate * (own * abs(rate) + stream * speed)); };
  return {damp(c.damping_spin.x, c.damping_speed.x, spin.x), damp(c.damping_spin.y, c.damping_speed.y, spin.y),
          damp(c.damping_spin.z, c.damping_speed.z, spin.z)};
}

/// The right-hand side.
template <class Real>
State<Real> rate_of(const Constants<Real>& c, const State<Real>& s, const Air<Real>& air) {
  using std::sqrt;
  const Rotation<Real> turn = rotation_of(s.attitude);
  const Vec<Real> v = s.velocity - turn.back(air.wind);
  const Real speed = sqrt(dot(v, v));
  const Vec<Real> carried = c.carried * v;
  const Vec<Real> wind_change = turn.back(air.change) - cross(s.spin, s.velocity - v);
  State<Real> rate;
  rate.attitude = turning(s.attitude, s.spin);
  rate.position = turn(s.velocity);
  const Vec<Real> force = cross(c.mass * s.velocity + carried, s.spin) + c.carried * wind_change +
                          air_force(c, v, speed, s.spin) - c.weight * turn.row_z;
  rate.velocity = c.inverse_mass * force;
  const Vec<Real> torque = cross(c.moment * s.spin, s.spin) + cross(carried, v) + air_torque(c, speed, s.spin);
  rate.spin = c.inverse_moment * torque;
  return rate;
}

}  // namespace wisp::leaf
