#pragma once
// One instance of a chain whose modes are systems (wisp/model/mode_systems.hpp): its velocities in its own axes, and
// the step that moves and turns it by them. Bounded, since velocities are clamped to their range.

#include <array>
#include <span>

#include "run/chain/chain_lane.hpp"
#include "run/chain/systems_program.hpp"

namespace wisp {

template <class Real>
struct SystemLane {
  std::array<Real, kSystemStates> rates{};  ///< velocity, then spin, in the body's axes
  Real length{};                            ///< steps that the mode lasts
};

/// A vector of the body in the world's axes.
template <class Real>
inline Vector3<Real> in_world(const Quaternion<Real>& q, const Vector3<Real>& v) {
  const Vector3<Real> axis{q[1], q[2], q[3]};
  const auto once = scaled(cross(axis, v), Real(2.0f));
  return added(added(v, scaled(once, q[0])), cross(axis, once));
}

template <class Real>
inline Vector3<Real> velocity_of(const SystemLane<Real>& lane) {
  return {lane.rates[0], lane.rates[1], lane.rates[2]};
}
template <class Real>
inline Vector3<Real> spin_of(const SystemLane<Real>& lane) {
  return {lane.rates[3], lane.rates[4], lane.rates[5]};
}

/// Takes over how a body moves and turns in the world.
template <class Real>
inline void take_rates(SystemLane<Real>& lane, const Quaternion<Real>& q, const BodyRates<Real>& rates) {
  const auto velocity = in_body(q, rates.velocity), spin = in_body(q, rates.spin);
  for (std::size_t k = 0; k < 3; ++k) {
    lane.rates[k] = velocity[k];
    lane.rates[k + 3] = spin[k];
  }
}

/// The velocities of the next step. `shocks`: six normal deviates with a stride; null: none.
template <class Real>
inline void next_rates(const SystemsProgram& program, std::uint32_t mode, const Quaternion<Real>& q, const Real* shocks,
                       int stride, SystemLane<Real>& lane) {
  const Real one(1.0f), two(2.0f);
  std::array<Real, kSystemStates + 3> seen;
  for (std::size_t k = 0; k < kSystemStates; ++k) seen[k] = lane.rates[k];
  seen[6] = two * (q[1] * q[3] - q[0] * q[2]);
  seen[7] = two * (q[2] * q[3] + q[0] * q[1]);
  seen[8] = one - two * (q[1] * q[1] + q[2] * q[2]);
  std::array<Real, kSystemStates> sum;
  const float* coefficient = program.coefficient.data() + std::size_t{mode} * kSystemStates * program.terms;
  for (std::size_t k = 0; k < kSystemStates; ++k) sum[k] = Real(coefficient[k * program.terms]);
  std::size_t term = 1;
  const auto add = [&](const Real& value) {
    for (std::size_t k = 0; k < kSystemStates; ++k) {
      sum[k] = sum[k] + Real(coefficient[k * program.terms + term]) * value;
    }
    ++term;
  };
  for (const Real& value : seen) add(value);
  if (program.degree == 2) {
    for (std::size_t i = 0; i < seen.size(); ++i) {
      for (std::size_t j = i; j < seen.size(); ++j) add(seen[i] * seen[j]);
    }
  }
  const float* noise = program.noise.data() + std::size_t{mode} * kSystemStates * kSystemStates;
  const float* range = program.range.data() + std::size_t{mode} * kSystemStates * 2;
  for (std::size_t k = 0; k < kSystemStates; ++k) {
    for (std::size_t i = 0; shocks && i <= k; ++i) {
      sum[k] = sum[k] + Real(noise[k * kSystemStates + i]) * shocks[i * static_cast<std::size_t>(stride)];
    }
    const Real least(range[2 * k]), most(range[2 * k + 1]);
    lane.rates[k] = sum[k] > most ? most : sum[k] > least ? sum[k] : least;
  }
}

/// How many steps a mode lasts, by a word.
inline float duration_of(const SystemsProgram& program, std::uint32_t mode, std::uint32_t word) {
  return static_cast<float>(program.steps[std::size_t{mode} * kSystemDurations + share_of(word, kSystemDurations)]);
}

/// One step of a body whose position and orientation lie in `shown`, with a stride.
template <class Real>
inline void system_step(const SystemsProgram& program, std::uint32_t mode, float step_seconds, const Real* shocks,
                        SystemLane<Real>& lane, Real* shown, int stride) {
  Quaternion<Real> q{shown[3 * stride], shown[4 * stride], shown[5 * stride], shown[6 * stride]};
  const auto before = in_world(q, velocity_of(lane));
  const auto spin = spin_of(lane);
  next_rates(program, mode, q, shocks, stride, lane);
  const Real half(0.5f * step_seconds);
  // The turn of a step, by the mean of the spins at its ends.
  const auto g = scaled(added(spin, spin_of(lane)), Real(0.25f * step_seconds));
  const Vector3<Real> axis{q[1], q[2], q[3]};
  const auto v = added(added(axis, scaled(g, q[0])), cross(axis, g));
  q = unit<Real>({q[0] - dot(axis, g), v[0], v[1], v[2]});
  const auto way = scaled(added(before, in_world(q, velocity_of(lane))), half);
  const Real most(kFarthest), least(-kFarthest);
  for (int k = 0; k < 3; ++k) {
    const Real at = shown[k * stride] + way[static_cast<std::size_t>(k)];
    shown[k * stride] = at > most ? most : at < least ? least : at;
  }
  for (int k = 0; k < 4; ++k) shown[(3 + k) * stride] = q[static_cast<std::size_t>(k)];
}

}  // namespace wisp
