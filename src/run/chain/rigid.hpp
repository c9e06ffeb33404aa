#pragma once
// Positions and rotations of rigid bodies, for any number type. Only + − × ÷ and square root, in the order written, so
// that results have the same bits everywhere. Quaternions are w, x, y, z and rotate body axes to world axes. Rotations
// of an orientation are Gibbs vectors, the axis times the tangent of half the angle: scaling one needs no trigonometry.

#include <array>

#include "run/lanes/lanes.hpp"

namespace wisp {

template <class Real>
using Vector3 = std::array<Real, 3>;
template <class Real>
using Quaternion = std::array<Real, 4>;

template <class Real>
inline Vector3<Real> added(const Vector3<Real>& a, const Vector3<Real>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <class Real>
inline Vector3<Real> taken(const Vector3<Real>& a, const Vector3<Real>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class Real>
inline Vector3<Real> scaled(const Vector3<Real>& a, Real factor) {
  return {a[0] * factor, a[1] * factor, a[2] * factor};
}
template <class Real>
inline Real dot(const Vector3<Real>& a, const Vector3<Real>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class Real>
inline Quaternion<Real> added(const Quaternion<Real>& a, const Quaternion<Real>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]};
}
template <class Real>
inline Quaternion<Real> taken(const Quaternion<Real>& a, const Quaternion<Real>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]};
}
template <class Real>
inline Quaternion<Real> scaled(const Quaternion<Real>& a, Real factor) {
  return {a[0] * factor, a[1] * factor, a[2] * factor, a[3] * factor};
}
template <class Real>
inline Real dot(const Quaternion<Real>& a, const Quaternion<Real>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}
template <class Real>
inline Vector3<Real> cross(const Vector3<Real>& a, const Vector3<Real>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Returns the quaternion scaled to norm 1; a zero quaternion is unchanged.
template <class Real>
inline Quaternion<Real> unit(const Quaternion<Real>& q) {
  const Real square = dot(q, q);
  if (!(square > Real(1e-30f))) return q;
  return scaled(q, Real(1.0f) / square_root(square));
}

/// Rotates an orientation about the world's z, by the cosine and sine of half the angle.
template <class Real>
inline Quaternion<Real> turned(Real half_cos, Real half_sin, const Quaternion<Real>& q) {
  return {half_cos * q[0] - half_sin * q[3], half_cos * q[1] - half_sin * q[2], half_cos * q[2] + half_sin * q[1],
          half_cos * q[3] + half_sin * q[0]};
}

/// Returns the time derivative of an orientation under an angular velocity in world axes.
template <class Real>
inline Quaternion<Real> quaternion_rate(const Vector3<Real>& spin, const Quaternion<Real>& q) {
  const Vector3<Real> axis{q[1], q[2], q[3]};
  const auto v = added(scaled(spin, q[0]), cross(spin, axis));
  return scaled(Quaternion<Real>{Real(0.0f) - dot(spin, axis), v[0], v[1], v[2]}, Real(0.5f));
}

/// Rotates a vector about z, by cosine and sine of the angle.
template <class Real>
inline Vector3<Real> turned(Real cos, Real sin, const Vector3<Real>& v) {
  return {cos * v[0] - sin * v[1], sin * v[0] + cos * v[1], v[2]};
}

/// Cosine and sine of half an angle about z, both times a common factor.
template <class Real>
struct LongTurn {
  Real cos;
  Real sin;
};

/// Returns the rotation about z that brings `from` nearest to `to`; the common factor is HalfTurn::nearness.
template <class Real>
inline LongTurn<Real> long_turn_between(const Quaternion<Real>& from, const Quaternion<Real>& to) {
  return {to[0] * from[0] + to[1] * from[1] + to[2] * from[2] + to[3] * from[3],
          to[3] * from[0] - to[0] * from[3] + to[2] * from[1] - to[1] * from[2]};
}

/// A rotation about z that brings one orientation nearest to another: cosine and sine of half its angle. nearness: for
/// unit quaternions 1 if they coincide after the rotation, 0 if no rotation about z helps.
template <class Real>
struct HalfTurn {
  Real cos;
  Real sin;
  Real nearness;
};

template <class Real>
inline HalfTurn<Real> turn_between(const Quaternion<Real>& from, const Quaternion<Real>& to) {
  const auto [w, z] = long_turn_between(from, to);
  const Real size = square_root(w * w + z * z);
  if (!(size > Real(1e-6f))) return {Real(1.0f), Real(0.0f), Real(0.0f)};
  const Real inverse = Real(1.0f) / size;
  return {w * inverse, z * inverse, size};
}

/// Returns the rotation about z that aligns the horizontal parts of two vectors; nearness: product of their lengths.
template <class Real>
inline HalfTurn<Real> turn_between(const Vector3<Real>& from, const Vector3<Real>& to) {
  const Real along = to[0] * from[0] + to[1] * from[1];
  const Real across = to[1] * from[0] - to[0] * from[1];
  const Real size = square_root(along * along + across * across);
  if (!(size > Real(1e-12f))) return {Real(1.0f), Real(0.0f), Real(0.0f)};
  // Halves the angle: cos² φ = (1 + cos 2φ) / 2. The larger of cosine and sine is computed first, for accuracy.
  const Real cos = along / size, sin = across / size;
  if (cos > Real(0.0f)) {
    const Real half = square_root(Real(0.5f) + Real(0.5f) * cos);
    return {half, Real(0.5f) * sin / half, size};
  }
  const Real half = square_root(Real(0.5f) - Real(0.5f) * cos);
  return {Real(0.5f) * sin / half, half, size};
}

/// Rotates an orientation by a Gibbs vector in world axes.
template <class Real>
inline Quaternion<Real> rotated(const Vector3<Real>& g, const Quaternion<Real>& q) {
  const Vector3<Real> axis{q[1], q[2], q[3]};
  const auto v = added(added(axis, scaled(g, q[0])), cross(g, axis));
  return unit<Real>({q[0] - dot(g, axis), v[0], v[1], v[2]});
}

}  // namespace wisp
