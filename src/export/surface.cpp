#include <cmath>
#include <numbers>

#include "export/outline.hpp"
#include "wisp/run/body_facet.hpp"

namespace wisp::exporting {

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

Surface leaf_blade(double half_width, double half_length) {
  constexpr int kRows = 12;
  constexpr double kFold = 0.3, kBend = 0.18;  // rise of the edges in half widths, and of the ends in half lengths
  const double width = half_width > 0 ? half_width : 0.03, length = half_length > 0 ? half_length : width;
  Surface leaf;
  for (int row = 0; row <= kRows; ++row) {
    // The leaf is widest below its middle.
    const double t = 2.0 * row / kRows - 1, across = width * std::cos(std::numbers::pi / 2 * t) * (1 - 0.4 * t) / 1.08;
    for (const int column : {-1, 0, 1}) {
      const double fold = column == 0 ? 0 : kFold * across;
      for (double place : {column * across, length * t, fold + kBend * length * t * t}) {
        leaf.places.push_back(static_cast<float>(place));
      }
      const double x = -kFold * column, y = -2 * kBend * t, size = std::sqrt(x * x + y * y + 1);
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

}  // namespace wisp::exporting
