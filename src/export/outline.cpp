// Bézier points of a spline by its polar form: L. Ramshaw, Blossoms are polar forms, CAGD 6 (1989), section 4.

#include "export/outline.hpp"

#include <cmath>
#include <numbers>

#include "model/bspline.hpp"
#include "wisp/export/export.hpp"
#include "wisp/run/body_facet.hpp"

namespace wisp::exporting {
namespace {

using Point = std::array<double, 2>;

// Returns the polar form of the piece between knots[span] and knots[span + 1] at three parameters.
Point blossom(const std::vector<double>& knots, std::span<const float> control, std::size_t span,
              const std::array<double, 3>& at) {
  std::array<Point, 4> points{};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t from = 2 * (span - 3 + k);
    points[k] = {control[from], control[from + 1]};
  }
  for (std::size_t level = 1; level <= 3; ++level) {
    for (std::size_t k = 3; k >= level; --k) {
      const double low = knots[span - 3 + k], high = knots[span + 1 + k - level];
      const double share = (at[level - 1] - low) / (high - low);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        points[k][axis] = (1 - share) * points[k - 1][axis] + share * points[k][axis];
      }
    }
  }
  return points[3];
}

}  // namespace

std::vector<float> outline_points(const std::vector<double>& knots, std::span<const double> control, int points) {
  std::vector<float> out;
  for (int p = 0; p < points; ++p) {
    const BasisWeights weights = basis(knots, static_cast<double>(p) / (points - 1));
    Point sum{};
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t from = 2 * (static_cast<std::size_t>(weights.first) + k);
      if (weights.weight[k] == 0) continue;
      for (std::size_t axis = 0; axis < 2; ++axis) sum[axis] += weights.weight[k] * control[from + axis];
    }
    out.insert(out.end(), {static_cast<float>(sum[0]), static_cast<float>(sum[1]), 0});
  }
  return out;
}

std::vector<std::array<double, 2>> bezier_points(const std::vector<double>& knots, std::span<const float> control) {
  std::vector<Point> points{{control[0], control[1]}};
  for (std::size_t span = 3; span + 4 < knots.size(); ++span) {
    const double a = knots[span], b = knots[span + 1];
    if (a == b) continue;
    points.push_back(blossom(knots, control, span, {a, a, b}));
    points.push_back(blossom(knots, control, span, {a, b, b}));
    points.push_back(blossom(knots, control, span, {b, b, b}));
  }
  return points;
}

std::vector<float> rings_of(const std::vector<double>& knots, std::span<const float> front,
                            std::span<const float> side) {
  const auto points_of = [&](std::span<const float> control) {
    return outline_points(knots, std::vector<double>(control.begin(), control.end()), 2 * kRings);
  };
  using Line = std::vector<float>;
  const Line seen = points_of(front), across = side.empty() ? Line(seen.size()) : points_of(side);
  Line out;
  for (std::size_t left = 0; left < seen.size() / 2; left += 3) {
    const std::size_t right = seen.size() - 3 - left;
    const auto middle = [&](const Line& line, std::size_t at) { return (line[right + at] + line[left + at]) / 2; };
    const auto half = [&](const Line& line, std::size_t at) { return (line[right + at] - line[left + at]) / 2; };
    out.insert(out.end(),
               {middle(seen, 0), middle(seen, 1), middle(across, 0), half(seen, 0), half(seen, 1), half(across, 1)});
  }
  return out;
}

std::vector<float> ring_places(const std::vector<float>& rings, int segments) {
  std::vector<float> vertices(rings.size() * static_cast<std::size_t>(segments)), places;
  ring_mesh(rings, segments, vertices);
  for (std::size_t k = 0; k < vertices.size(); k += kVertexNumbers) {
    places.insert(places.end(), {vertices[k], vertices[k + 1], vertices[k + 2]});
  }
  return places;
}

std::vector<std::uint16_t> ring_corners(int rings, int segments) {
  std::vector<std::uint32_t> corners(static_cast<std::size_t>(3 * ring_triangle_count(rings, segments)));
  ring_triangles(rings, segments, corners);
  return {corners.begin(), corners.end()};
}

Surface leaf_blade(double half_first, double half_second) {
  constexpr int kRows = 12;
  constexpr double kFold = 0.3, kBend = 0.18;  // rise of the edges in half widths, and of the ends in half lengths
  const double length = half_first > 0 ? half_first : 0.03, width = half_second > 0 ? half_second : length;
  Surface leaf;
  for (int row = 0; row <= kRows; ++row) {
    // The leaf is widest below its middle.
    const double t = 2.0 * row / kRows - 1, across = width * std::cos(std::numbers::pi / 2 * t) * (1 - 0.4 * t) / 1.08;
    for (const int column : {-1, 0, 1}) {
      const double fold = column == 0 ? 0 : kFold * across;
      for (double place : {length * t, -column * across, fold + kBend * length * t * t}) {
        leaf.places.push_back(static_cast<float>(place));
      }
      const double x = -2 * kBend * t, y = kFold * column, size = std::sqrt(x * x + y * y + 1);
      for (double normal : {x / size, y / size, 1 / size}) leaf.normals.push_back(static_cast<float>(normal));
    }
    for (int left = 3 * row; row < kRows && left < 3 * row + 2; ++left) {
      for (int corner : {left, left + 1, left + 4, left, left + 4, left + 3}) {
        leaf.triangles.push_back(static_cast<std::uint16_t>(corner));
      }
    }
  }
  return leaf;
}

std::vector<double> operating_point(const Model& model) {
  if (const auto* outline = std::get_if<OutlineView>(&model.view); outline && !outline->shape.empty()) {
    return control_points(outline->shape, std::vector<double>(outline->shape.count(), 0.0));
  }
  if (const auto* arx = std::get_if<ArxModel>(&model.dynamics)) return arx->output_mean;
  if (const auto* switched = std::get_if<SwitchedArxModel>(&model.dynamics)) return switched->output_mean;
  return std::vector<double>(model.outputs.size(), 0.0);
}

Result<void> check_take(const Model& model, const Take& take) {
  const bool travels = take.loop && std::holds_alternative<ChainModel>(model.dynamics);
  const bool right = (!travels || take.travel.size() == take.instances) && take.frames > 0 && take.instances > 0 &&
                     take.outputs == model.outputs.size() &&
                     take.values.size() == take.sides * take.frames * take.instances * take.outputs && take.rate_hz > 0;
  if (right) return {};
  return Error{"the take has " + std::to_string(take.outputs) + " outputs and " + std::to_string(take.frames) +
               " frames, expected one of this model, which has " + std::to_string(model.outputs.size()) + " outputs"};
}

}  // namespace wisp::exporting

namespace wisp {

std::vector<float> outline_of(const Model& model, const Take& take, std::size_t frame, std::size_t instance,
                              int points) {
  const auto row = take.at(frame, instance);
  const auto spatial = exporting::outline_points(std::get<OutlineView>(model.view).knots,
                                                 std::vector<double>(row.begin(), row.end()), points);
  std::vector<float> flat;
  for (std::size_t k = 0; k < spatial.size(); k += 3) flat.insert(flat.end(), {spatial[k], spatial[k + 1]});
  return flat;
}

}  // namespace wisp
