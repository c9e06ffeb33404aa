// Vertex animation textures: vertex positions in rows of a picture, frame by frame, for a vertex shader to read.

#include <algorithm>
#include <array>
#include <cmath>

#include "base/json_text.hpp"
#include "export/outline.hpp"
#include "wisp/export/export.hpp"

namespace wisp {
namespace {

using namespace exporting;

using Vector = std::array<double, 3>;

// Rotates and moves points as a body: v + 2 u × (u × v + w v) for a unit quaternion (w, u).
std::vector<float> moved(std::span<const float> points, std::span<const float> row) {
  const auto cross = [](const Vector& a, const Vector& b) {
    return Vector{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const Vector u{row[4], row[5], row[6]};
  const double w = row[3], two = 2 / (w * w + u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
  std::vector<float> out;
  for (std::size_t k = 0; k < points.size(); k += 3) {
    const Vector v{points[k], points[k + 1], points[k + 2]}, once = cross(u, v);
    const Vector turn = cross(u, {once[0] + w * v[0], once[1] + w * v[1], once[2] + w * v[2]});
    for (std::size_t axis = 0; axis < 3; ++axis)
      out.push_back(static_cast<float>(row[axis] + v[axis] + two * turn[axis]));
  }
  return out;
}

// Returns the surface of a flame's rings.
std::vector<float> flame_points(const OutlineView& view, const Take& take, std::size_t frame) {
  const auto side = take.sides > 1 ? take.at(frame, 0, 1) : std::span<const float>();
  return ring_places(rings_of(view.knots, take.at(frame, 0), side), kSegments);
}

// Returns the vertex positions in all frames, x, y, z, and triangles; nothing if the outputs are no shape.
Surface surface_of(const Model& model, const Take& take) {
  Surface surface, leaf;
  const auto* outline = std::get_if<OutlineView>(&model.view);
  const auto* pose = std::get_if<PoseView>(&model.view);
  if (pose) leaf = leaf_blade(pose->half_width, pose->half_length);
  for (std::size_t frame = 0; frame < take.frames && (outline || pose); ++frame) {
    const auto points = outline ? flame_points(*outline, take, frame) : moved(leaf.places, take.at(frame, 0));
    surface.places.insert(surface.places.end(), points.begin(), points.end());
  }
  surface.triangles = outline ? ring_corners(kRings, kSegments) : leaf.triangles;
  return surface;
}

}  // namespace

Result<VertexAnimation> vertex_animation(const Model& model, const Take& take) {
  if (auto ok = check_take(model, take); !ok) return ok.error();
  constexpr std::size_t kMaxFrames = 8192;  // of two rows each: 16384 is the largest texture of most engines
  if (take.frames > kMaxFrames)
    return Error{"there are " + std::to_string(take.frames) + " frames, expected at most 8192; ask for fewer seconds"};
  const Surface surface = surface_of(model, take);
  const auto& places = surface.places;
  if (places.empty())
    return Error{"the model's outputs are neither an outline nor a pose, so there are no points to move"};
  VertexAnimation out{.columns = places.size() / 3 / take.frames, .rows = 2 * take.frames};
  std::array<float, 3> lowest{places[0], places[1], places[2]}, highest = lowest;
  for (std::size_t k = 0; k < places.size(); ++k) {
    lowest[k % 3] = std::min(lowest[k % 3], places[k]);
    highest[k % 3] = std::max(highest[k % 3], places[k]);
  }
  out.rgb.resize(2 * places.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double range = std::max(1e-9, static_cast<double>(highest[k % 3]) - lowest[k % 3]);
    const auto word =
        static_cast<unsigned>(std::lround(65535 * (static_cast<double>(places[k]) - lowest[k % 3]) / range));
    out.rgb[k] = static_cast<std::uint8_t>(word >> 8);
    out.rgb[places.size() + k] = static_cast<std::uint8_t>(word & 0xff);
  }
  JsonText json;
  json.object().value(out.columns, "points").value(take.frames, "frames").value(take.rate_hz, "rate_hz");
  json.value(take.loop, "loop").values(lowest, "lowest").values(highest, "highest");
  if (!take.travel.empty()) {
    const auto [x, y, z] = take.travel[0];
    json.values(std::array{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}, "travel");
  }
  out.json = json.values(surface.triangles, "triangles").end().text() + "\n";
  return out;
}

}  // namespace wisp
