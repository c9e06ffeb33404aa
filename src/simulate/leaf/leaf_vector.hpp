#pragma once
// Vectors and quaternions of the leaf, over the number type, so that the equations can be run on numbers that count.

#include <array>
#include <cmath>

namespace wisp::leaf {

template <class Real>
struct Vec {
  Real x{}, y{}, z{};

  friend Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec operator-(Vec a, Vec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  /// Element by element.
  friend Vec operator*(Vec a, Vec b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  friend Vec operator*(Real s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
};

template <class Real>
Real dot(Vec<Real> a, Vec<Real> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Real>
Vec<Real> cross(Vec<Real> a, Vec<Real> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class Real>
struct Quaternion {
  Real w{}, x{}, y{}, z{};
};

/// A rotation as its three rows.
template <class Real>
struct Rotation {
  Vec<Real> row_x, row_y, row_z;

  Vec<Real> operator()(Vec<Real> v) const { return {dot(row_x, v), dot(row_y, v), dot(row_z, v)}; }
  Vec<Real> back(Vec<Real> v) const { return v.x * row_x + v.y * row_y + v.z * row_z; }
};

/// The rotation of a quaternion of any length but zero.
template <class Real>
Rotation<Real> rotation_of(Quaternion<Real> q) {
  const Real ww = q.w * q.w, xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const Real two = Real(2) / (ww + xx + yy + zz), one(1);
  const Real xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z, wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  return {{one - two * (yy + zz), two * (xy - wz), two * (xz + wy)},
          {two * (xy + wz), one - two * (xx + zz), two * (yz - wx)},
          {two * (xz - wy), two * (yz + wx), one - two * (xx + yy)}};
}

/// ½ q ⊗ (0, ω): how fast the attitude turns.
template <class Real>
Quaternion<Real> turning(Quaternion<Real> q, Vec<Real> spin) {
  const Vec<Real> h = Real(0.5) * spin;
  return {-(q.x * h.x) - q.y * h.y - q.z * h.z, q.w * h.x + q.y * h.z - q.z * h.y, q.w * h.y + q.z * h.x - q.x * h.z,
          q.w * h.z + q.x * h.y - q.y * h.x};
}

inline Vec<double> vec_of(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }
inline std::array<double, 3> array_of(Vec<double> v) { return {v.x, v.y, v.z}; }
inline Quaternion<double> quaternion_of(const std::array<double, 4>& a) { return {a[0], a[1], a[2], a[3]}; }

/// The quaternion of length 1 in its direction.
///
/// Precondition: not zero.
inline std::array<double, 4> normalised(const std::array<double, 4>& q) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return {q[0] / length, q[1] / length, q[2] / length, q[3] / length};
}

}  // namespace wisp::leaf
