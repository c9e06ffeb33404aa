#pragma once
// Explicit Runge–Kutta steps of the leaf, over the number type.

#include <array>

#include "simulate/leaf/leaf_equations.hpp"

namespace wisp::leaf {

/// state + h · rate.
template <class Real>
State<Real> moved(const State<Real>& s, Real h, const State<Real>& rate) {
  return {{s.attitude.w + h * rate.attitude.w, s.attitude.x + h * rate.attitude.x, s.attitude.y + h * rate.attitude.y,
           s.attitude.z + h * rate.attitude.z},
          s.position + h * rate.position,
          s.velocity + h * rate.velocity,
          s.spin + h * rate.spin};
}

/// The same with an attitude of length 1.
template <class Real>
State<Real> with_unit_attitude(State<Real> s) {
  using std::sqrt;
  Quaternion<Real>& q = s.attitude;
  const Real scale = Real(1) / sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  q = {scale * q.w, scale * q.x, scale * q.y, scale * q.z};
  return s;
}

// `rate` is called with a state and the share of the step that has passed.

template <class Real, class Rate>
State<Real> classical_step(const State<Real>& s, Real h, Rate rate) {
  const State<Real> first = rate(s, 0.0);
  const State<Real> second = rate(moved(s, Real(0.5) * h, first), 0.5);
  const State<Real> third = rate(moved(s, Real(0.5) * h, second), 0.5);
  const State<Real> fourth = rate(moved(s, h, third), 1.0);
  const Real sixth = Real(1.0 / 6) * h;
  return with_unit_attitude(
      moved(moved(moved(moved(s, sixth, first), Real(2) * sixth, second), Real(2) * sixth, third), sixth, fourth));
}

}  // namespace wisp::leaf
