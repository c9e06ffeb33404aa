#include "films/flame_flipbook.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "wisp/draw/flame.hpp"
#include "wisp/export/export.hpp"

namespace wisp::cli {
namespace {

// The halo has no end of its own: from `room` within the frame to its edge it fades to nothing, so that no frame shows
// as a box.
void fade_edges(float room, Image& image) {
  const auto share = [&](int at, int size) {
    const float t = std::min(1.0F, static_cast<float>(std::min(at, size - 1 - at)) / room);
    return t * t * (3 - 2 * t);
  };
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      std::uint32_t& pixel = image.row(y)[static_cast<std::size_t>(x)];
      const float kept = share(x, image.width()) * share(y, image.height());
      std::uint32_t faded = 0;
      for (int shift = 0; shift < 32; shift += 8) {
        faded |= static_cast<std::uint32_t>(std::lround(kept * static_cast<float>(pixel >> shift & 0xff))) << shift;
      }
      pixel = faded;
    }
  }
}

}  // namespace

Result<Flipbook> flame_flipbook(const Model& model, const Take& take, int height) {
  constexpr int kPoints = 96;
  constexpr float kHalo = 0.35F;  // room around the flame, in its heights
  if (!is_flame(model)) {
    return Error{
        "the model is no flame to draw as light; an outline goes into a .json, a body's motion into a .glb, a lamp "
        "into a .c"};
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
  // A halo that is nearly gone within its room, so that the fading hardly shows.
  const FlameStyle style{.glow_reach = 0.25F, .candle = false};
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
    fade_edges(room, book.frames.back());
  }
  return book;
}

}  // namespace wisp::cli
