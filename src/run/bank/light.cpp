// Light source of a flame, from the polygon of its control points.

#include <cmath>

#include "run/bank/bank_state.hpp"

namespace wisp {
namespace {

// Candles: 1850 to 1930 K. Soot's light at 480 nm is proportional to about the 16th power of its temperature.
constexpr float kKelvinAtRest = 1900;

// Area and centroid of a polygon.
struct Polygon {
  float area = 0, x = 0, y = 0;
};

Polygon polygon_of(const float* points, std::size_t numbers) {
  constexpr auto kLanes = static_cast<std::size_t>(Bank::State::kLanes);
  Polygon sum;
  for (std::size_t k = 0; k < numbers; k += 2) {
    const float *a = points + k * kLanes, *b = points + (k + 2) % numbers * kLanes;
    const float cross = a[0] * b[kLanes] - b[0] * a[kLanes];
    sum.area += 0.5f * cross;
    sum.x += (a[0] + b[0]) * cross / 6;
    sum.y += (a[kLanes] + b[kLanes]) * cross / 6;
  }
  if (!(std::abs(sum.area) > 1e-12f)) return {};
  return {std::abs(sum.area), sum.x / sum.area, sum.y / sum.area};
}

}  // namespace

FlameLight Bank::State::light_of(int slot) const {
  const int block = slot / kLanes, lane = slot % kLanes;
  if (shape.across > 0) see_round(block, false);
  const Polygon seen = polygon_of((shape.across > 0 ? round_points.data() : shown_of(block)) + lane, visible);
  FlameLight light{{seen.x, seen.y, 0}, rest_area > 0 ? seen.area / rest_area : 0};
  if (shape.across > 0) light.position[2] = polygon_of(round_points.data() + visible * kLanes + lane, visible).x;
  light.kelvin = kKelvinAtRest * std::sqrt(std::sqrt(std::sqrt(std::sqrt(light.intensity))));
  return light;
}

std::optional<FlameLight> Bank::light(InstanceId id) const {
  if (!state_->valid(id) || state_->polyline.points == 0) return {};
  return state_->light_of(static_cast<int>(id.slot));
}

}  // namespace wisp
