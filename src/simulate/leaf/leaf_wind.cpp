#include "simulate/leaf/leaf_wind.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/leaf/leaf_vector.hpp"
#include "simulate/option_range.hpp"
#include "simulate/random_numbers.hpp"

namespace wisp {
namespace {

using leaf::array_of;
using leaf::vec_of;
using Vec = leaf::Vec<double>;

// Height of a gust and its slope: 0 outside, 1 between the edges, smooth steps at both.
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

// Catmull and Rom's cubic between the second (0) and third (1) of four consecutive rows; its slope is continuous.
struct Cubic {
  double value;
  double slope;  // a row
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

Result<void> check(const LeafWindOptions& o) {
  return flow::check_ranges("wind", {
                                        {"speed", o.speed, 0, 30},
                                        {"gust_seconds", o.gust_seconds, 0.02, 60},
                                        {"rest_seconds", o.rest_seconds, 0, 60},
                                        {"edge_seconds", o.edge_seconds, 0.001, 10},
                                        {"travel_speed", o.travel_speed, 0.1, 1000},
                                    });
}

}  // namespace

Result<LeafWind> LeafWind::create(const LeafWindOptions& options, double seconds) {
  if (auto good = check(options); !good) return good.error();
  LeafWind wind;
  if (options.kind == LeafWindKind::kGusts) wind.add_gusts(options, seconds);
  return wind;
}

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

void LeafWind::add_gusts(const LeafWindOptions& o, double seconds) {
  flow::RandomNumbers random(o.seed, 21);
  for (double at = random.uniform(0, o.rest_seconds); at < seconds;) {
    const Vec way = towards(random.uniform(-180, 180));
    Gust gust;
    gust.start = at;
    gust.seconds = o.gust_seconds * random.uniform(0.6, 1.8);
    gust.edge = std::min(o.edge_seconds, gust.seconds / 2);
    gust.velocity = array_of(o.speed * random.uniform(0.4, 1.6) * way);
    gust.slowness = array_of(1 / o.travel_speed * way);
    gusts_.push_back(gust);
    at += gust.seconds + o.rest_seconds * random.uniform(0.4, 1.6);
  }
}

double LeafWind::fastest() const {
  const auto speed = [](const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); };
  double most = 0;
  for (const Gust& gust : gusts_) most = std::max(most, speed(gust.velocity));
  for (const auto& row : track_.rows) most = std::max(most, speed(row));
  return most;
}

WindSample LeafWind::at(const std::array<double, 3>& place, const std::array<double, 3>& moving, double seconds) const {
  Vec velocity{}, change{};
  const Vec x = vec_of(place), v = vec_of(moving);
  for (const Gust& gust : gusts_) {
    const Vec slowness = vec_of(gust.slowness);
    const Bump bump = bump_at(gust, seconds - gust.start - leaf::dot(slowness, x));
    velocity = velocity + bump.height * vec_of(gust.velocity);
    change = change + bump.slope * (1 - leaf::dot(slowness, v)) * vec_of(gust.velocity);
  }
  if (!track_.rows.empty()) {
    const WindSample measured = sample_of(track_, seconds);
    velocity = velocity + vec_of(measured.velocity);
    change = change + vec_of(measured.change);
  }
  return {array_of(velocity), array_of(change)};
}

}  // namespace wisp
