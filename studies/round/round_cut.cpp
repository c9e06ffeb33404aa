#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "film_round.hpp"
#include "model/bspline.hpp"
#include "wisp/model/shape_components.hpp"

namespace {

using namespace wisp;

// Where an outline crosses a height on its left flank and on its right one.
std::optional<std::array<double, 2>> crossings(std::span<const double> control, std::span<const double> knots,
                                               double y) {
  constexpr int kSteps = 200;
  std::vector<std::array<double, 2>> curve;
  for (int k = 0; k <= kSteps; ++k) {
    const BasisWeights weights = basis(knots, static_cast<double>(k) / kSteps);
    std::array<double, 2> point{};
    for (int r = 0; r < 4; ++r) {
      point[0] += weights.weight[r] * control[2 * (weights.first + r)];
      point[1] += weights.weight[r] * control[2 * (weights.first + r) + 1];
    }
    curve.push_back(point);
  }
  std::optional<double> first, last;
  for (std::size_t k = 1; k < curve.size(); ++k) {
    const auto &a = curve[k - 1], &b = curve[k];
    if ((a[1] < y) == (b[1] < y)) continue;
    const double x = a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
    if (!first) first = x;
    last = x;
  }
  if (!first || *first == *last) return std::nullopt;
  return std::array{*first, *last};
}

}  // namespace

std::optional<RoundCut> cut_at(const Recording& rings, std::size_t row, double y) {
  std::size_t count = 0;
  while (find_channel(rings, "ring" + std::to_string(count) + ".r")) ++count;
  const auto knots = numbers_attribute(rings, "knots");
  const std::vector<double> all = *knots ? **knots : uniform_knots(static_cast<int>(2 * count));
  std::array<std::array<double, 2>, 2> seen{};
  for (int plane = 0; plane < 2; ++plane) {
    std::vector<double> shape(4 * count);
    for (std::size_t k = 0; k < count; ++k) {
      const auto at = [&](const std::string& part) {
        return rings.channels[*find_channel(rings, "ring" + std::to_string(k) + part)].samples[row];
      };
      shape[2 * k] = at(".r"), shape[2 * k + 1] = at(".y");
      shape[2 * count + 2 * k] = at(plane == 0 ? ".x" : ".z");
      shape[2 * count + 2 * k + 1] = at(plane == 0 ? ".tx" : ".tz");
    }
    if (std::isnan(shape[0])) return std::nullopt;
    const auto cut = crossings(control_points(shape), all, y);
    if (!cut) return std::nullopt;
    seen[static_cast<std::size_t>(plane)] = *cut;
  }
  return RoundCut{(seen[0][0] + seen[0][1]) / 2, (seen[1][0] + seen[1][1]) / 2,
                  (seen[0][1] - seen[0][0] + seen[1][1] - seen[1][0]) / 4};
}
