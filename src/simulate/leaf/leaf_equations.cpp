#include "simulate/leaf/leaf_equations.hpp"

#include <cmath>
#include <numbers>

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
