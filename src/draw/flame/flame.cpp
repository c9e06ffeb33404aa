#include "wisp/draw/flame.hpp"

#include <algorithm>
#include <vector>

#include "draw/flame/flame_layers.hpp"
#include "draw/flame/night.hpp"

namespace wisp {

using namespace drawing;

namespace {

void expose(LightField& field, float exposure) {
  if (exposure == 1) return;
  for (Plane* plane : {&field.red, &field.green, &field.blue}) {
    for (float& value : plane->values) value *= exposure;
  }
}

}  // namespace

bool burns(const FlameScene& scene) { return scene.seconds_since_lit <= scene.seconds_since_out; }

void draw_flames(Image& image, std::span<const Flame> flames, const FlameStyle& asked) {
  if (image.empty() || flames.empty()) return;
  const FlameStyle style = held(asked);
  std::vector<Candle> candles;
  for (const Flame& flame : flames) candles.push_back(prepared(flame, style, image.width(), image.height()));
  draw_behind(image, candles, style);
  LightField field(image.width(), image.height());
  for (const Candle& candle : candles) add_own_light(field, candle, style);
  if (style.glow > 0) add_halo(field, glow_rings(style, largest_unit(candles)));
  expose(field, style.exposure);
  add_light(image, field);
}

void draw_flame(Image& image, std::span<const Point> outline, const FlameScene& scene, const FlameStyle& style) {
  const Flame flame{outline, scene};
  draw_flames(image, std::span(&flame, 1), style);
}

void draw_night(Image& image) {
  const Tone& tone = Tone::get();
  for (int y = 0; y < image.height(); ++y) {
    const Light light = night_light(static_cast<float>(y), image.height());
    const Light code{tone.code(light.red), tone.code(light.green), tone.code(light.blue)};
    const auto row = image.row(y);
    for (int x = 0; x < image.width(); ++x) {
      const float dither = dither_at(x, y);
      row[x] = 0xFF000000U | dithered(code.red, dither) << 16 | dithered(code.green, dither) << 8 |
               dithered(code.blue, dither);
    }
  }
}

FlameScene framed(int width, int height) {
  FlameScene scene;
  scene.pixels_per_unit = std::min(static_cast<float>(height) * 0.38F, static_cast<float>(width) * 0.45F);
  scene.base = {static_cast<float>(width) / 2, static_cast<float>(height) * 0.77F};
  return scene;
}

}  // namespace wisp
