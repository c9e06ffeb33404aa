#pragma once
// Velocity change of one instance of a segment chain due to wind. Source: section 4.4 of the paper.

#include "run/chain/chain_program.hpp"
#include "run/chain/rigid.hpp"

namespace wisp {

/// Velocity change (m/s) or wind (channel units) below which a gust ends: nothing is computed until the next one.
inline constexpr float kMinGust = 1e-4f;

/// Bound of velocity changes, metres per second.
inline constexpr float kMaxGust = 1e3f;

/// Velocity change, wind and normal wind of the last step.
template <class Real>
struct GustLane {
  Vector3<Real> change{};
  Vector3<Real> wind{};
  Vector3<Real> press{};  ///< a quarter of the normal wind
};

template <class Real>
inline bool stirs(const Vector3<Real>& v) {
  for (const Real& x : v) {
    if (x > Real(kMinGust) || x < Real(-kMinGust)) return true;
  }
  return false;
}

/// Returns a quarter of the component of `wind` along the normal of a flat body: half of the unit normal takes fewer
/// operations. `wind`: the wind minus the body's velocity change.
template <class Real>
inline Vector3<Real> quarter_press(const Quaternion<Real>& q, const Vector3<Real>& wind) {
  const Vector3<Real> half_normal{q[1] * q[3] + q[0] * q[2], q[2] * q[3] - q[0] * q[1],
                                  Real(0.5f) - (q[1] * q[1] + q[2] * q[2])};
  return scaled(half_normal, dot(half_normal, wind));
}

/// Makes one step of the response to wind. Returns the velocity change, within ±kMaxGust.
template <class Real>
inline Vector3<Real> blow(const GustProgram& program, GustLane<Real>& lane, const Vector3<Real>& wind,
                          const Vector3<Real>& press) {
  lane.wind = wind;
  lane.press = press;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& of = axis < 2 ? program.ground : program.vertical;
    const Real sum = Real(of[0]) * lane.change[axis] + Real(of[1]) * wind[axis] + Real(of[2]) * press[axis];
    const Real most(kMaxGust), least(-kMaxGust);
    lane.change[axis] = sum > most ? most : sum < least ? least : sum;
  }
  return lane.change;
}

/// Returns whether there is wind now, was wind in the last step, or remains a velocity change.
template <class Real>
inline bool gust_lasts(const GustLane<Real>& lane, const Vector3<Real>& wind) {
  return stirs(wind) || stirs(lane.change) || stirs(lane.wind);
}

}  // namespace wisp
