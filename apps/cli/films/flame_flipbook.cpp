#include "films/flame_flipbook.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "wisp/draw/flame.hpp"
#include "wisp/export/export.hpp"

namespace wisp::cli {

Result<Flipbook> flame_flipbook(const Model& model, const Take& take, int height) {
  constexpr int kPoints = 96;
  constexpr float kHalo = 0.35F;  // room around the flame, in its heights
  if (!is_flame(model)) {
    return Error{"the model is no flame to draw as light; write its outline as .json, or its motion as .glb"};
  }
  if (height < 16 || height > 2048) {
    return Error{"--height is " + std::to_string(height) + " pixels, expected 16 to 2048"};
  }
  float left = 0, right = 0, top = 0;
  std::vector<std::vector<Point>> outlines;
  for (std::size_t frame = 0; frame < take.frames; ++frame) {
    const auto points = outline_of(model, take, frame, 0, kPoints);
    outlines.emplace_back();
    for (std::size_t k = 0; k < points.size(); k += 2) {
      outlines.back().push_back({points[k], points[k + 1]});
      left = std::min(left, points[k]);
      right = std::max(right, points[k]);
      top = std::max(top, points[k + 1]);
    }
  }
  FlameStyle style{.candle = false};
  FlameScene scene;
  scene.pixels_per_unit = static_cast<float>(height) / (top + 2 * kHalo);
  const float room = kHalo * scene.pixels_per_unit;
  scene.base = {room - left * scene.pixels_per_unit, static_cast<float>(height) - room};
  const int width = static_cast<int>(std::ceil((right - left) * scene.pixels_per_unit + 2 * room));
  Flipbook book{.rate_hz = take.rate_hz, .loop = take.loop, .pivot = scene.base};
  for (const auto& outline : outlines) {
    book.frames.emplace_back(width, height);
    draw_flame(book.frames.back(), outline, scene, style);
    make_light(book.frames.back());
  }
  return book;
}

}  // namespace wisp::cli
