#include "run/outline_lanes.hpp"

#include <cmath>

#include "wisp/model/bspline.hpp"

namespace wisp {

std::span<PolylinePoint> make_polyline(const OutlineView& view, int points, Arena& arena) {
  const auto table = arena.take<PolylinePoint>(points);
  if (arena.measures()) return table;
  for (int k = 0; k < points; ++k) {
    const BasisWeights weights = basis(view.knots, static_cast<double>(k) / (points - 1));
    table[k].first = static_cast<std::uint32_t>(weights.first);
    for (int i = 0; i < 4; ++i) {
      const double weight = weights.weight[i];
      table[k].weight[i] = std::abs(weight) < kLeastCoefficient ? 0.0f : static_cast<float>(weight);
    }
  }
  return table;
}

}  // namespace wisp
