// Vertex animation textures: places of points in rows of a picture, frame by frame, for a vertex shader to read.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/json_text.hpp"
#include "export/outline.hpp"
#include "wisp/export/export.hpp"

namespace wisp {
namespace {

using namespace exporting;

constexpr std::size_t kOutlinePoints = 32, kBodyPoints = 24;

// A flat ellipse turned and moved as a body is.
std::vector<float> body_points(std::span<const float> row, double half_width, double half_length) {
  std::array<double, 4> q{1, 0, 0, 0};
  if (row.size() >= 7) std::copy_n(row.begin() + 3, 4, q.begin());
  const double two = 2 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const auto [w, x, y, z] = q;
  const std::array<double, 3> across{1 - two * (y * y + z * z), two * (x * y + w * z), two * (x * z - w * y)};
  const std::array<double, 3> along{two * (x * y - w * z), 1 - two * (x * x + z * z), two * (y * z + w * x)};
  std::vector<float> points;
  for (std::size_t k = 0; k < kBodyPoints; ++k) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(k) / kBodyPoints;
    const double a = half_width * std::cos(angle), b = half_length * std::sin(angle);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      points.push_back(static_cast<float>(row[axis] + a * across[axis] + b * along[axis]));
    }
  }
  return points;
}

// Places of all points in all frames, x, y, z; nothing where the outputs are no shape.
std::vector<float> places_of(const Model& model, const Take& take) {
  std::vector<float> places;
  for (std::size_t frame = 0; frame < take.frames; ++frame) {
    const auto row = take.at(frame, 0);
    std::vector<float> points;
    if (const auto* outline = std::get_if<OutlineView>(&model.view)) {
      points = outline_points(outline->knots, std::vector<double>(row.begin(), row.end()), kOutlinePoints);
    } else if (const auto* pose = std::get_if<PoseView>(&model.view)) {
      const double width = pose->half_width > 0 ? pose->half_width : kUnknownHalfWidth;
      points = body_points(row, width, pose->half_length > 0 ? pose->half_length : width);
    }
    places.insert(places.end(), points.begin(), points.end());
  }
  return places;
}

// A fan of a body's points; of an outline the strip between its two sides.
std::vector<std::size_t> triangles_of(bool outline) {
  std::vector<std::size_t> corners;
  for (std::size_t k = 0; k + 2 < kBodyPoints && !outline; ++k) corners.insert(corners.end(), {0, k + 1, k + 2});
  for (std::size_t k = 0; k + 1 < kOutlinePoints / 2 && outline; ++k) {
    const std::size_t across = kOutlinePoints - 1 - k;
    corners.insert(corners.end(), {k, across, across - 1, k, across - 1, k + 1});
  }
  return corners;
}

}  // namespace

Result<VertexAnimation> vertex_animation(const Model& model, const Take& take) {
  if (auto ok = check_take(model, take); !ok) return ok.error();
  const auto places = places_of(model, take);
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
  const bool outline = std::holds_alternative<OutlineView>(model.view);
  JsonText json;
  json.object().value(out.columns, "points").value(take.frames, "frames").value(take.rate_hz, "rate_hz");
  json.value(take.loop, "loop").values(lowest, "lowest").values(highest, "highest");
  if (!take.travel.empty()) {
    const auto [x, y, z] = take.travel[0];
    json.values(std::array{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)}, "travel");
  }
  out.json = json.values(triangles_of(outline), "triangles").end().text() + "\n";
  return out;
}

}  // namespace wisp
