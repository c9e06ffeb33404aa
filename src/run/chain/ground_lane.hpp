#pragma once
// Landing of a chain's instance on the ground, a level plane: its lowest corner touches, the body slides on a little,
// tilts onto the nearer side, and rests.

#include <optional>

#include "run/chain/chain_lane.hpp"

namespace wisp {

/// Duration of coming to rest: long enough not to look like a jump, too short to be noticed.
inline constexpr float kSettleSeconds = 0.35f;

/// Returns the extent of a body below its centre, down to its lowest corner: the body is a flat rectangle.
template <class Real>
inline Real reach_of(const ChainProgram& program, const Quaternion<Real>& q) {
  if (program.channels < 7 || !(program.half_width > 0.0f || program.half_length > 0.0f)) return Real(0.0f);
  const Real two(2.0f), zero(0.0f);
  Real across = two * (q[1] * q[3] - q[0] * q[2]), along = two * (q[2] * q[3] + q[0] * q[1]);
  if (across < zero) across = zero - across;
  if (along < zero) along = zero - along;
  return across * Real(program.half_width) + along * Real(program.half_length);
}

/// Returns the extent of a displayed body below its centre if the body has reached the ground, else nothing.
template <class Real>
inline std::optional<Real> reach_touching(const ChainProgram& program, const Real* shown, int stride, float ground) {
  const Real& height = shown[2 * stride];
  if (!(height < Real(ground + (program.half_width + program.half_length)))) return {};
  Real reach(0.0f);
  if (program.channels >= 7) {
    reach = reach_of<Real>(program, {shown[3 * stride], shown[4 * stride], shown[5 * stride], shown[6 * stride]});
  }
  if (!(height < Real(ground) + reach)) return {};
  return reach;
}

/// Starts the settling of a lane whose body, of this pose and these rates, has reached the ground.
template <class Real>
inline void touch(ChainLane<Real>& lane, const BodyState<Real>& body, float ground) {
  lane.settled = Real(0.0f);
  lane.base = {body.position[0], body.position[1], Real(ground)};
  const auto slip = ChainMover<Real>::bounded(scaled(body.rates.velocity, Real(kSettleSeconds)), kFarthest);
  lane.slip[0] = {slip[0], slip[1], Real(0.0f)};
  lane.touched = body.orientation;
}

/// Returns the rotation that lays a body flat on its nearer side, as a Gibbs vector.
template <class Real>
inline Vector3<Real> lean_to_ground(const Quaternion<Real>& q) {
  const Real two(2.0f);
  const Vector3<Real> normal{two * (q[1] * q[3] + q[0] * q[2]), two * (q[2] * q[3] - q[0] * q[1]),
                             Real(1.0f) - two * (q[1] * q[1] + q[2] * q[2])};
  // The rotation from the normal n to z or, if n points down, −z: for z, the Gibbs vector is n × z / (1 + n·z).
  const Real side = normal[2] < Real(0.0f) ? Real(-1.0f) : Real(1.0f);
  const Real factor = side / (Real(1.0f) + normal[2] * side);
  return {normal[1] * factor, Real(0.0f) - normal[0] * factor, Real(0.0f)};
}

/// Advances a settling lane by one step and writes its pose to `out`; `stride`: distance between channels in `out`.
template <class Real>
inline void settle_step(ChainLane<Real>& lane, const ChainProgram& program, Real* out, int stride) {
  // `laid` is computed in the first step after touchdown, since the touchdown step is the most expensive.
  if (!(lane.settled > Real(0.0f)) && program.channels >= 7) lane.laid = lean_to_ground(lane.touched);
  if (lane.settled < Real(1.0f)) lane.settled = lane.settled + Real(program.step_seconds / kSettleSeconds);
  const bool rests = !(lane.settled < Real(1.0f));
  const Real passed = rests ? Real(1.0f) : lane.settled;
  const Real rest = Real(1.0f) - passed;
  // The body slides with a speed that decays as (1 − s)²: a third of the distance at constant speed.
  const Real way = (Real(1.0f) - rest * rest * rest) * Real(1.0f / 3.0f);
  const Real lean = passed * passed * (Real(3.0f) - (passed + passed));
  // Clamped, since the distance in a manipulated saved bank may be large.
  const auto position = ChainMover<Real>::bounded(added(lane.base, scaled(lane.slip[0], way)), 2 * kFarthest);
  for (int axis = 0; axis < 3; ++axis) out[axis * stride] = position[static_cast<std::size_t>(axis)];
  if (program.channels < 7) return;
  const auto q = rotated(scaled(lane.laid, lean), lane.touched);
  // At rest the body lies flat up to rounding, so it has no extent.
  if (!rests) out[2 * stride] = out[2 * stride] + reach_of(program, q);
  for (int k = 0; k < 4; ++k) out[(3 + k) * stride] = q[static_cast<std::size_t>(k)];
}

}  // namespace wisp
