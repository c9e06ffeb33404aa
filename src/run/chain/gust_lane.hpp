#pragma once
// Velocity change of one instance of a segment chain due to wind. Source: section 4.4 of the paper.

#include <array>

#include "run/chain/chain_program.hpp"
#include "run/chain/rigid.hpp"

namespace wisp {

/// Threshold of velocity changes and wind, below which a gust ends: nothing is computed until the next.
inline constexpr float kMinGust = 1e-4f;

/// Bound of velocity changes, metres per second.
inline constexpr float kMaxGust = 1e3f;

template <class Real>
struct GustLane {
  // Histories, newest first.
  std::array<Vector3<Real>, kMaxGustOrder> change{};
  std::array<Vector3<Real>, kMaxGustOrder> wind{};
  std::array<Vector3<Real>, kMaxGustOrder> press{};  ///< a quarter of the normal wind
};

template <class Real>
inline bool stirs(const Vector3<Real>& v) {
  for (const Real& x : v) {
    if (x > Real(kMinGust) || x < Real(-kMinGust)) return true;
  }
  return false;
}

/// Returns a quarter of the wind component normal to a flat body, relative to its velocity: half a normal is cheaper
/// than a whole one.
template <class Real>
inline Vector3<Real> quarter_press(const Quaternion<Real>& q, const Vector3<Real>& wind) {
  const Vector3<Real> half_normal{q[1] * q[3] + q[0] * q[2], q[2] * q[3] - q[0] * q[1],
                                  Real(0.5f) - (q[1] * q[1] + q[2] * q[2])};
  return scaled(half_normal, dot(half_normal, wind));
}

/// Makes one step. Returns the change of velocity; `idle` lanes without wind cost nothing.
template <class Real>
inline Vector3<Real> blow(const GustProgram& program, GustLane<Real>& lane, const Vector3<Real>& wind,
                          const Vector3<Real>& press) {
  for (int k = program.order - 1; k > 0; --k) {
    lane.wind[static_cast<std::size_t>(k)] = lane.wind[static_cast<std::size_t>(k - 1)];
    lane.press[static_cast<std::size_t>(k)] = lane.press[static_cast<std::size_t>(k - 1)];
  }
  lane.wind[0] = wind;
  lane.press[0] = press;
  Vector3<Real> change;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& lags = axis < 2 ? program.ground : program.vertical;
    for (std::size_t k = 0; k < static_cast<std::size_t>(program.order); ++k) {
      const Real kept = Real(lags[k][0]) * lane.change[k][axis];
      change[axis] = k == 0 ? kept : change[axis] + kept;
      change[axis] = change[axis] + Real(lags[k][1]) * lane.wind[k][axis];
      change[axis] = change[axis] + Real(lags[k][2]) * lane.press[k][axis];
    }
    const Real most(kMaxGust), least(-kMaxGust);
    change[axis] = change[axis] > most ? most : change[axis] < least ? least : change[axis];
  }
  for (int k = program.order - 1; k > 0; --k) {
    lane.change[static_cast<std::size_t>(k)] = lane.change[static_cast<std::size_t>(k - 1)];
  }
  lane.change[0] = change;
  return change;
}

/// Returns whether there is wind, or a remaining response.
template <class Real>
inline bool gust_lasts(const GustProgram& program, const GustLane<Real>& lane, const Vector3<Real>& wind) {
  if (stirs(wind)) return true;
  for (std::size_t k = 0; k < static_cast<std::size_t>(program.order); ++k) {
    if (stirs(lane.change[k]) || stirs(lane.wind[k])) return true;
  }
  return false;
}

}  // namespace wisp
