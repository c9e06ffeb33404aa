#include "simulate/leaf/leaf_flight.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/option_range.hpp"

namespace wisp::leaf {
namespace {

// Force of the relative air flow, in body axes. `v` is the leaf's velocity relative to the air.
Vec air_force(const Constants& c, const Vec& v, double speed, const Vec& spin) {
  const double along2 = v[0] * v[0] + v[1] * v[1], normal2 = v[2] * v[2];
  // No force at rest, where the ratios below are undefined.
  const double over = 1 / (speed + 1e-12);
  const double lift = c.lift * v[2] * over;
  const double drag = c.drag * speed + c.drag_normal * normal2 * over;
  const double swirl_x = c.swirl_x * spin[0], swirl_y = c.swirl_y * spin[1];
  const Vec by_rotation{swirl_y * v[2], -(swirl_x * v[2]), swirl_x * v[1] - swirl_y * v[0]};
  const double in_plane = lift * v[2] - drag;
  return Vec{in_plane * v[0], in_plane * v[1], -(lift * along2) - drag * v[2]} + by_rotation;
}

Vec air_torque(const Constants& c, double speed, const Vec& spin) {
  Vec torque{};
  for (std::size_t k = 0; k < 3; ++k) {
    torque[k] = -(spin[k] * (c.damping_spin[k] * std::abs(spin[k]) + c.damping_speed[k] * speed));
  }
  return torque;
}

}  // namespace

Constants constants_of(const Leaf& leaf) {
  const double a = leaf.length / 2, b = leaf.width / 2;
  const double area = std::numbers::pi * a * b, density = leaf.air_density;
  const LeafAir& air = leaf.air;
  const LeafInertia inertia = leaf_inertia(leaf);
  Constants c;
  c.carried = inertia.added_mass;
  c.mass = inertia.mass;
  c.moment = inertia.moment + inertia.added_moment;
  for (std::size_t k = 0; k < 3; ++k) {
    c.inverse_mass[k] = 1 / (c.mass + c.carried[k]);
    c.inverse_moment[k] = 1 / c.moment[k];
  }
  c.weight = c.mass * leaf.gravity;
  c.lift = density * area * air.translational_lift;
  c.drag = density * area * air.drag_edgewise / 2;
  c.drag_normal = density * area * (air.drag_broadside - air.drag_edgewise) / 2;
  c.swirl_x = density * air.rotational_lift * 8 / 3 * a * b * b;
  c.swirl_y = density * air.rotational_lift * 8 / 3 * a * a * b;
  c.damping_spin = {density * air.damping_by_spin * 4 / 15 * a * b * b * b * b,
                    density * air.damping_by_spin * 4 / 15 * b * a * a * a * a,
                    density * air.spin_drag * area * a * a * a * a};
  const double in_stream = density * air.damping_by_speed * area;
  c.damping_speed = {in_stream * b * b * b, in_stream * a * a * a, density * air.spin_drag * area * a * a * a};
  return c;
}

LeafState rate_of(const Constants& c, const LeafState& s, const WindSample& wind) {
  const Rotation turn = rotation_of(s.attitude);
  const Vec v = s.velocity - turn.back(wind.velocity);
  const double speed = std::sqrt(dot(v, v));
  const Vec carried = c.carried * v;
  const Vec wind_change = turn.back(wind.change) - cross(s.spin, s.velocity - v);
  LeafState rate;
  rate.attitude = turning(s.attitude, s.spin);
  rate.position = turn(s.velocity);
  const Vec force = cross(c.mass * s.velocity + carried, s.spin) + c.carried * wind_change +
                    air_force(c, v, speed, s.spin) - c.weight * turn.row_z;
  rate.velocity = c.inverse_mass * force;
  const Vec torque = cross(c.moment * s.spin, s.spin) + cross(carried, v) + air_torque(c, speed, s.spin);
  rate.spin = c.inverse_moment * torque;
  return rate;
}

}  // namespace wisp::leaf

namespace wisp {
namespace {

// Wind, m/s, above which steps shrink in inverse proportion: drag decays at a rate proportional to the speed of the
// air. At 2.5 m/s steps of 1/60 s are unstable.
constexpr double kFastestForWholeSteps = 1.6;

bool finite(const LeafState& s) {
  double sum = 0;
  for (const double value : s.attitude) sum += value;
  for (const auto* part : {&s.position, &s.velocity, &s.spin})
    for (const double value : *part) sum += value;
  return std::isfinite(sum);
}

double squared_length(const leaf::Quaternion& q) { return q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]; }

// state + h · rate.
LeafState moved(const LeafState& s, double h, const LeafState& rate) {
  using leaf::operator+, leaf::operator*;
  LeafState out{{}, s.position + h * rate.position, s.velocity + h * rate.velocity, s.spin + h * rate.spin};
  for (std::size_t k = 0; k < 4; ++k) out.attitude[k] = s.attitude[k] + h * rate.attitude[k];
  return out;
}

}  // namespace

Result<LeafFlight> LeafFlight::begin(const Leaf& leaf, const LeafWind& wind, const LeafState& state,
                                     double longest_step) {
  if (auto good = check(leaf); !good) return good.error();
  auto in_range = flow::check_ranges("leaf", {{"longest_step", longest_step, 1e-6, 0.05}});
  if (!in_range) return in_range.error();
  if (!finite(state) || !(squared_length(state.attitude) > 0))
    return Error{"leaf: the state to begin with is not finite or its attitude has no length"};
  LeafFlight flight;
  flight.constants_ = leaf::constants_of(leaf);
  flight.wind_ = &wind;
  flight.longest_step_ = longest_step * std::min(1.0, kFastestForWholeSteps / wind.fastest());
  flight.state_ = state;
  flight.state_.attitude = leaf::normalised(state.attitude);
  return flight;
}

LeafState LeafFlight::rate(const LeafState& s, double at) const {
  if (wind_->calm()) return leaf::rate_of(constants_, s, {});
  return leaf::rate_of(constants_, s, wind_->at(s.position, leaf_world_velocity(s), at));
}

// Makes a classical Runge-Kutta step of fourth order, and normalises the attitude.
void LeafFlight::step(double h) {
  const LeafState first = rate(state_, seconds_);
  const LeafState second = rate(moved(state_, 0.5 * h, first), seconds_ + 0.5 * h);
  const LeafState third = rate(moved(state_, 0.5 * h, second), seconds_ + 0.5 * h);
  const LeafState fourth = rate(moved(state_, h, third), seconds_ + h);
  const double before = state_.velocity[1], sixth = 1.0 / 6 * h;
  state_ = moved(moved(moved(moved(state_, sixth, first), 2 * sixth, second), 2 * sixth, third), sixth, fourth);
  const double scale = 1 / std::sqrt(squared_length(state_.attitude));
  for (double& part : state_.attitude) part *= scale;
  const double after = state_.velocity[1];
  if (before * after < 0) stalls_.push_back(seconds_ + h * before / (before - after));
  seconds_ += h;
}

Result<void> LeafFlight::advance(double seconds) {
  // A tolerance, since rounding would otherwise add a step.
  const double steps = std::max(1.0, std::ceil(seconds / longest_step_ - 1e-9));
  for (int k = 0; k < static_cast<int>(steps); ++k) step(seconds / steps);
  if (!finite(state_)) return Error{"leaf: the fall is no longer finite after " + std::to_string(seconds_) + " s"};
  return {};
}

}  // namespace wisp
