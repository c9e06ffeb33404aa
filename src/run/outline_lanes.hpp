#pragma once
// The outline of a block of instances as polylines: basis weights are a table, made once.

#include <cstdint>
#include <span>

#include "run/arena.hpp"
#include "run/lanes.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// One point of the polyline: four control points from `first` on, and their weights.
struct PolylinePoint {
  std::uint32_t first;
  float weight[4];
};

/// Lays out the table of `points` points at equal steps of the spline's parameter and, unless the arena measures, fills
/// it.
///
/// Precondition: points >= 2.
std::span<PolylinePoint> make_polyline(const OutlineView& view, int points, Arena& arena);

/// One coordinate (0 x, 1 y) of one point of the polyline; `controls` is [control point][x, y][lane].
template <class N>
inline Reals<N> polyline_lanes(const PolylinePoint& point, int coordinate, const typename N::Real* controls) {
  const auto* p = controls + (2 * point.first + coordinate) * N::kLanes;
  auto sum = all<Reals<N>>(point.weight[0]) * load<Reals<N>>(p);
  for (int k = 1; k < 4; ++k) sum = sum + all<Reals<N>>(point.weight[k]) * load<Reals<N>>(p + 2 * k * N::kLanes);
  return sum;
}

}  // namespace wisp
