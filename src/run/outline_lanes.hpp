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
inline void polyline_lanes(const PolylinePoint& point, int coordinate, const typename N::Real* controls,
                           typename N::Real* out) {
  using Real = typename N::Real;
  const Real* p = controls + (2 * point.first + coordinate) * N::kLanes;
  const Real w0(point.weight[0]), w1(point.weight[1]), w2(point.weight[2]), w3(point.weight[3]);
  constexpr int kNext = 2 * N::kLanes;
  for (int lane = 0; lane < N::kLanes; ++lane) {
    out[lane] = w0 * p[lane] + w1 * p[lane + kNext] + w2 * p[lane + 2 * kNext] + w3 * p[lane + 3 * kNext];
  }
}

}  // namespace wisp
