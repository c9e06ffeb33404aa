#include "simulate/leaf/leaf_wind.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/leaf/leaf.hpp"
#include "simulate/random_numbers.hpp"

namespace wisp {
namespace {

using leaf::Vec, leaf::operator+, leaf::operator*;

constexpr double kSpeed = 1;           // speed of a typical gust, m/s
constexpr double kGustSeconds = 0.3;   // duration of a typical gust; each is 0.6 to 1.8 times as long
constexpr double kEdgeSeconds = 0.06;  // rise and decay time of a gust: a sudden onset would have no derivative
constexpr double kTravelSpeed = 8;     // m/s: travel speed of a gust's front

// Height and slope of a gust: 0 outside, 1 between the edges, smooth steps at both.
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

// Catmull-Rom cubic between the second (0) and third (1) of four consecutive rows; its slope is continuous.
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

}  // namespace wisp
