#include "simulate/leaf/leaf_flight.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/option_range.hpp"
#include "simulate/random_numbers.hpp"

namespace wisp {
namespace {

using leaf::Vec, leaf::operator+, leaf::operator*;

constexpr double kSpeed = 1;           // speed of a typical gust, m/s
constexpr double kGustSeconds = 0.3;   // duration of a typical gust; each is 0.6 to 1.8 times as long
constexpr double kEdgeSeconds = 0.06;  // rise and decay time of a gust: a jump would have no derivative
constexpr double kTravelSpeed = 8;     // m/s: travel speed of a gust's front

// A gust's share of its maximum velocity (0 outside, 1 between the edges, smooth between) and its slope, 1/s.
struct Bump {
  double height = 0;
  double slope = 0;
};

Bump bump_at(const Gust& gust, double since) {
  if (since <= 0 || since >= gust.seconds) return {};
  const double from_end = std::min(since, gust.seconds - since) / gust.edge;
  if (from_end >= 1) return {1, 0};
  const double sign = since < gust.seconds / 2 ? 1 : -1;
  return {from_end * from_end * (3 - 2 * from_end), sign * 6 * from_end * (1 - from_end) / gust.edge};
}

Vec towards(double degrees) {
  const double radians = degrees * std::numbers::pi / 180;
  return {std::cos(radians), std::sin(radians), 0};
}

// Value and slope of a Catmull-Rom cubic between the second (0) and third (1) of four rows; the slope is continuous.
struct Cubic {
  double value;
  double slope;  // slope per row
};

Cubic cubic_through(double a, double b, double c, double d, double t) {
  const double one = (c - a) / 2, two = a - 2.5 * b + 2 * c - d / 2, three = (d - a) / 2 + 1.5 * (b - c);
  return {b + t * (one + t * (two + t * three)), one + t * (2 * two + t * 3 * three)};
}

WindSample sample_of(const MeasuredWind& track, double seconds) {
  const auto last = static_cast<long>(track.rows.size()) - 1;
  const double row = std::clamp((seconds - track.begins) * track.rate_hz, 0.0, static_cast<double>(last));
  const long first = std::min(static_cast<long>(row), std::max(0L, last - 1));
  const auto at = [&](long k, std::size_t axis) {
    return track.rows[static_cast<std::size_t>(std::clamp(k, 0L, last))][axis];
  };
  const bool holds = row <= 0 || row >= static_cast<double>(last);
  WindSample sample;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Cubic found = cubic_through(at(first - 1, axis), at(first, axis), at(first + 1, axis), at(first + 2, axis),
                                      row - static_cast<double>(first));
    sample.velocity[axis] = found.value;
    sample.change[axis] = holds ? 0 : found.slope * track.rate_hz;
  }
  return sample;
}

using std::numbers::pi;

// Lamb's integrals for the long and the short axis of an ellipsoid, divided by its thickness, in the limit of zero
// thickness. With λ = b² tan²θ they become integrals of smooth, even functions of θ over half of their period, where
// equidistant sums converge faster than any power of the step.
struct LambIntegrals {
  double long_axis = 0;
  double short_axis = 0;
};

LambIntegrals lamb_integrals(double a, double b) {
  constexpr int kSteps = 1024;
  LambIntegrals sum;
  for (int k = 0; k < kSteps; ++k) {
    const double angle = (k + 0.5) / kSteps * pi / 2;
    const double cos2 = std::cos(angle) * std::cos(angle);
    const double across = std::sqrt(a * a * cos2 + b * b * (1 - cos2));
    sum.long_axis += cos2 / (across * across * across);
    sum.short_axis += cos2 / across;
  }
  const double step = pi / 2 / kSteps;
  return {2 * a * b * step * sum.long_axis, 2 * a / b * step * sum.short_axis};
}

}  // namespace

LeafWind LeafWind::of_gusts(std::vector<Gust> gusts) {
  LeafWind wind;
  wind.gusts_ = std::move(gusts);
  return wind;
}

LeafWind LeafWind::of_track(MeasuredWind track) {
  LeafWind wind;
  wind.track_ = std::move(track);
  return wind;
}

LeafWind LeafWind::gusty(std::uint64_t seed, double seconds) {
  LeafWind wind;
  flow::RandomNumbers random(seed, 21);
  for (double at = random.uniform(0, kRestSeconds); at < seconds;) {
    const Vec way = towards(random.uniform(-180, 180));
    Gust gust;
    gust.start = at;
    gust.seconds = kGustSeconds * random.uniform(0.6, 1.8);
    gust.edge = std::min(kEdgeSeconds, gust.seconds / 2);
    gust.velocity = kSpeed * random.uniform(0.4, 1.6) * way;
    gust.slowness = 1 / kTravelSpeed * way;
    wind.gusts_.push_back(gust);
    at += gust.seconds + kRestSeconds * random.uniform(0.4, 1.6);
  }
  return wind;
}

double LeafWind::fastest() const {
  const auto speed = [](const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); };
  double most = 0;
  for (const Gust& gust : gusts_) most = std::max(most, speed(gust.velocity));
  for (const auto& row : track_.rows) most = std::max(most, speed(row));
  return most;
}

WindSample LeafWind::at(const std::array<double, 3>& place, const std::array<double, 3>& moving, double seconds) const {
  WindSample sum;
  for (const Gust& gust : gusts_) {
    const Bump bump = bump_at(gust, seconds - gust.start - leaf::dot(gust.slowness, place));
    sum.velocity = sum.velocity + bump.height * gust.velocity;
    sum.change = sum.change + bump.slope * (1 - leaf::dot(gust.slowness, moving)) * gust.velocity;
  }
  if (track_.rows.empty()) return sum;
  const WindSample measured = sample_of(track_, seconds);
  return {sum.velocity + measured.velocity, sum.change + measured.change};
}

Result<void> check(const Leaf& leaf) {
  return flow::check_ranges("leaf", {
                                        {"length in metres", leaf.length, 0.001, 1},
                                        {"width in metres", leaf.width, 0.001, leaf.length},
                                        {"areal density in kg/m²", leaf.areal_density, 0.001, 10},
                                        {"air density in kg/m³", leaf.air_density, 0.01, 100},
                                        {"gravity in m/s²", leaf.gravity, 0, 100},
                                        {"rotational lift", leaf.air.rotational_lift, 0, 10},
                                        {"translational lift", leaf.air.translational_lift, 0, 10},
                                        {"drag broadside", leaf.air.drag_broadside, 0, 20},
                                        {"drag edgewise", leaf.air.drag_edgewise, 0, leaf.air.drag_broadside},
                                        {"damping by speed", leaf.air.damping_by_speed, 0, 20},
                                        {"damping by spin", leaf.air.damping_by_spin, 0, 100},
                                        {"spin drag", leaf.air.spin_drag, 0, 20},
                                    });
}

LeafInertia leaf_inertia(const Leaf& leaf) {
  const double a = leaf.length / 2, b = leaf.width / 2;
  LeafInertia inertia;
  inertia.mass = leaf.areal_density * pi * a * b;
  const double quarter = inertia.mass / 4;
  inertia.moment = {quarter * b * b, quarter * a * a, quarter * (a * a + b * b)};
  // A plate without thickness has added mass only broadside, and added inertia only about the axes in its plane.
  const LambIntegrals lamb = lamb_integrals(a, b);
  const double air = 8 * pi / 3 * leaf.air_density * a * b;
  inertia.added_mass = {0, 0, air / (lamb.long_axis + lamb.short_axis)};
  inertia.added_moment = {air * b * b / 5 / (lamb.long_axis + 2 * lamb.short_axis),
                          air * a * a / 5 / (lamb.short_axis + 2 * lamb.long_axis), 0};
  return inertia;
}

double leaf_energy(const Leaf& leaf, const LeafState& state) {
  const LeafInertia inertia = leaf_inertia(leaf);
  double energy = inertia.mass * leaf.gravity * state.position[2];
  for (std::size_t k = 0; k < 3; ++k) {
    energy += (inertia.mass + inertia.added_mass[k]) * state.velocity[k] * state.velocity[k] / 2;
    energy += (inertia.moment[k] + inertia.added_moment[k]) * state.spin[k] * state.spin[k] / 2;
  }
  return energy;
}

std::array<double, 3> leaf_world_velocity(const LeafState& state) {
  return leaf::rotation_of(state.attitude)(state.velocity);
}

std::array<double, 3> leaf_normal(const LeafState& state) { return leaf::rotation_of(state.attitude)({0, 0, 1}); }

}  // namespace wisp

namespace wisp::leaf {
namespace {

// Returns the force of the relative air flow, in body axes. `v` is the leaf's velocity relative to the air.
Vec air_force(const Constants& c, const Vec& v, double speed, const Vec& spin) {
  const double along2 = v[0] * v[0] + v[1] * v[1], normal2 = v[2] * v[2];
  // Adding 1e-12 avoids 0 / 0 at rest, where there is no force.
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

// Wind, m/s, above which steps shrink in inverse proportion to it: drag damps motion at a rate proportional to the
// speed of the air. At 2.5 m/s, steps of 1/60 s are unstable.
constexpr double kFastestForWholeSteps = 1.6;

constexpr double kStableRates = 1.2;  // maximum of step · fastest_rate(): above about 1.5, steps diverge

// Returns the rate of the fastest motions, 1/s: rotation across the width plus drag, at the speed of a flat fall.
double fastest_rate(const Leaf& leaf) {
  const double drag = leaf.air_density / leaf.areal_density, speed = std::sqrt(2 * leaf.gravity / drag);
  return speed * (1 / leaf.width + 1.5 * drag);
}

bool finite(const LeafState& s) {
  double sum = 0;
  for (const double value : s.attitude) sum += value;
  for (const auto* part : {&s.position, &s.velocity, &s.spin})
    for (const double value : *part) sum += value;
  return std::isfinite(sum);
}

double squared_length(const leaf::Quaternion& q) { return q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]; }

// Returns state + h · rate.
LeafState moved(const LeafState& s, double h, const LeafState& rate) {
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
  flight.longest_step_ =
      std::min(longest_step * std::min(1.0, kFastestForWholeSteps / wind.fastest()), kStableRates / fastest_rate(leaf));
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
  // The tolerance 1e-9 prevents rounding from adding a step.
  const double steps = std::max(1.0, std::ceil(seconds / longest_step_ - 1e-9));
  for (int k = 0; k < static_cast<int>(steps); ++k) step(seconds / steps);
  if (!finite(state_)) return Error{"leaf: the fall is no longer finite after " + std::to_string(seconds_) + " s"};
  return {};
}

}  // namespace wisp
