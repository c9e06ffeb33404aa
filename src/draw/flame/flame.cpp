#include "wisp/draw/flame.hpp"

#include <algorithm>
#include <vector>

#include "draw/flame/flame_layers.hpp"
#include "draw/flame/room.hpp"

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

void show_state(const LitState& state, FlameScene& scene) {
  const auto seconds = [](std::chrono::nanoseconds age) {
    return age == kNever ? kLongAgo : std::chrono::duration<float>(age).count();
  };
  scene.seconds_since_lit = seconds(state.since_lit);
  scene.seconds_since_out = seconds(state.since_out);
  scene.size = state.size;
}

void SmokeDrift::blow(float wind, const LitState& state, std::chrono::nanoseconds step_time, FlameScene& scene) {
  // A wind of 1 carries smoke by this, in flame heights a second; real smoke would leave the picture at once.
  constexpr float kSmokeCarried = 1.5F;
  if (state.since_out == kNever) return;
  if (state.since_out <= step_time) sum_ = count_ = 0;
  sum_ += wind;
  count_ += 1;
  scene.wind = kSmokeCarried * sum_ / count_;
}

bool burns(const FlameScene& scene) { return scene.seconds_since_lit <= scene.seconds_since_out; }

void draw_flames(Image& image, std::span<const Flame> flames, const FlameStyle& asked) {
  if (image.empty() || flames.empty()) return;
  const FlameStyle style = clamped(asked);
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

void draw_room(Image& image, std::span<const Flame> flames, const FlameStyle& asked) {
  if (image.empty()) return;
  const FlameStyle style = clamped(asked);
  std::vector<Stand> stands;
  for (const Flame& flame : flames) stands.push_back(stand_of(flame.scene, style, lamp_of(flame)));
  Room room(image.width(), image.height());
  LightField codes = room.lit(stands);
  const Tone& tone = Tone::get();
  for (Plane* plane : {&codes.red, &codes.green, &codes.blue}) {
    for (float& value : plane->values) value = tone.code(value);
  }
  std::vector<float> scratch(static_cast<std::size_t>(codes.width()) + 2),
      dither(static_cast<std::size_t>(image.width()));
  Row row(image.width());
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) dither[static_cast<std::size_t>(x)] = rounding_at(x, y);
    spread(codes, Between(y, codes.height()), scratch, row, image.width());
    write_codes(row, dither.data(), image.row(y).data(), 0, image.width());
  }
}

FlameScene framed(int width, int height) {
  FlameScene scene;
  scene.pixels_per_unit = std::min(static_cast<float>(height) * 0.31F, static_cast<float>(width) * 0.45F);
  scene.base = {static_cast<float>(width) / 2, static_cast<float>(height) * 0.63F};
  return scene;
}

}  // namespace wisp
