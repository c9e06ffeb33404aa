#include "draw/flame/flame_layers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace wisp::drawing {
namespace {

// Durations of re-ignition and decay, in seconds.
constexpr float kReIgnition = 0.40F;
constexpr float kDecay = 0.16F;

// The area of a calm flame in square model units: a quarter as wide as high, tapering. Its light is 1.
constexpr float kCalmArea = 0.15F;

float clamped(float value, float low, float high) { return std::isnan(value) ? low : std::clamp(value, low, high); }

FlameScene clamped(FlameScene scene) {
  scene.base.x = clamped(scene.base.x, -1e5F, 1e5F);
  scene.base.y = clamped(scene.base.y, -1e5F, 1e5F);
  scene.pixels_per_unit = clamped(scene.pixels_per_unit, 1, 10000);
  scene.seconds_since_lit = clamped(scene.seconds_since_lit, 0, kLongAgo);
  scene.seconds_since_out = clamped(scene.seconds_since_out, 0, kLongAgo);
  if (scene.size) scene.size = clamped(*scene.size, 0, 1);
  scene.wind = clamped(scene.wind, -8, 8);
  return scene;
}

// Scale of outline and light of a growing or shrinking flame.
struct Stage {
  float scale = 1;
  FlameMood mood;
};

// Returns brightness and colour of a flame that has grown to the share `grown`.
FlameMood re_igniting(float grown) { return {0.5F + 0.5F * grown, 0.25F + 0.75F * smooth_step(0.15F, 0.9F, grown)}; }

Stage stage_of(const FlameScene& scene) {
  Stage stage;
  if (burns(scene)) {
    const float grown = scene.size.value_or(smooth_step(0, kReIgnition, scene.seconds_since_lit));
    stage.mood = re_igniting(grown);
    if (!scene.size) stage.scale = 0.22F + 0.78F * grown;
    return stage;
  }
  const float gone = 1 - scene.size.value_or(1 - smooth_step(0, kDecay, scene.seconds_since_out));
  stage.mood = {1 - gone, 1 - gone};
  if (!scene.size) stage.scale = 1 - 0.55F * gone;
  return stage;
}

// Returns the share of soot, 0 to 1: a very small flame burns blue.
float sooting(const FlameShape& shape) { return smooth_step(0.06F, 0.40F, shape.height); }

Lamp lamp_of(const FlameShape& shape, const FlameMood& mood) {
  const float area = std::min(3.0F, shape.area / kCalmArea);
  const float glowing = mood.brightness * (0.06F + 0.94F * mood.soot);
  return {shape.middle, glowing * std::pow(area, 0.7F)};
}

// Table of light by the amount of glowing soot in view (0 none … 1 the most): rim, body and core, softly blended.
class SootRamp {
 public:
  SootRamp() {
    const Light rim = emission_of(kRim);
    const Light body = emission_of(kBody);
    const Light core = emission_of(kCore);
    for (int k = 0; k <= kSteps; ++k) {
      const float v = static_cast<float>(k) / kSteps;
      const float to_rim = smooth_step(0.0F, 0.42F, v);
      const float to_body = smooth_step(0.30F, 0.66F, v);
      const float to_core = smooth_step(0.56F, 0.94F, v);
      Light light = to_rim * rim;
      light = (1 - to_body) * light + to_body * body;
      table_[k] = (1 - to_core) * light + to_core * core;
    }
  }

  Light at(float soot) const {
    const float x = std::clamp(soot, 0.0F, 1.0F) * kSteps;
    const int k = std::min(static_cast<int>(x), kSteps - 1);
    const float part = x - static_cast<float>(k);
    return (1 - part) * table_[k] + part * table_[k + 1];
  }

 private:
  static constexpr int kSteps = 256;
  std::array<Light, kSteps + 1> table_{};
};

// Returns the amount of glowing soot, 0 to 1, at the share t of the way from base to tip: low around the wick, high in
// the luminous zone, lower at the tip, where soot burns off.
float soot_profile(float t) {
  const float rise = 0.04F + 0.34F * smooth_step(0.04F, 0.22F, t) + 0.62F * smooth_step(0.14F, 0.44F, t);
  const float burn_off = 1 - 0.55F * smooth_step(0.74F, 1.04F, t);
  return rise * burn_off;
}

// Returns the depth of soot: the whole thickness; near the base only inside the mantle, which it would turn purple.
float soot_depth(float t, float thick) {
  const float shell = 0.50F * (1 - smooth_step(0.05F, 0.34F, t));
  return std::max(0.0F, thick - shell) / (1 - shell);
}

// Returns the light of the blue mantle: a thin shell of burning gas, seen edge-on at the sides, that fades upwards.
float mantle(float t, float thick) {
  const float shell = std::exp(-7.0F * thick * thick) + 0.05F;
  return shell * (1 - smooth_step(0.00F, 0.27F, t));
}

// Adds the flame's light to the field. `shade`, 0 … 1 over the shape's box, dims the light; empty: no dimming.
void add_flame_light(LightField& field, const FlameShape& shape, const FlameMood& mood, const Plane& shade) {
  if (shape.empty() || shape.thickest <= 0) return;
  const SootRamp ramp;
  const Light blue = emission_of(kBase);
  const float per_reach = 1 / std::max(1e-3F, shape.reach);
  for (int y = 0; y < shape.box.height; ++y) {
    for (int x = 0; x < shape.box.width; ++x) {
      const float covered = shape.coverage.row(y)[x];
      if (covered == 0) continue;
      const float thick = std::min(1.0F, shape.thickness.row(y)[x] / shape.thickest);
      const float dx = static_cast<float>(shape.box.x + x) + 0.5F - shape.base.x;
      const float dy = static_cast<float>(shape.box.y + y) + 0.5F - shape.base.y;
      const float t = std::sqrt(dx * dx + dy * dy) * per_reach;
      const Light soot = ramp.at(mood.soot * soot_depth(t, thick) * soot_profile(t));
      const Light light = soot + 0.26F * mantle(t, thick) * blue;
      const float clear = shade.values.empty() ? 1 : 1 - shade.row(y)[x];
      field.add(shape.box.x + x, shape.box.y + y, mood.brightness * covered * clear * light);
    }
  }
}

// Returns the share of the flame's light that the wick hides at each pixel: most, as the gas before the wick is thin.
Plane wick_shade(const Candle& candle) {
  constexpr float kHides = 0.82F;
  const PixelBox& box = candle.shape.box;
  Plane shade(box.width, box.height);
  for (int y = 0; y < box.height; ++y) {
    for (int x = 0; x < box.width; ++x) shade.row(y)[x] = kHides * wick_at(candle.wick, box.x + x, box.y + y);
  }
  return shade;
}

// Adds the glowing end of the wick: dim while the flame burns, fading for seconds after extinction.
void add_ember(LightField& field, const Candle& candle) {
  const FlameScene& scene = candle.scene;
  if (candle.wick.empty() || (burns(scene) && candle.shape.empty())) return;
  const float out = scene.seconds_since_out;
  // The ember becomes visible as the flame shrinks.
  const float bare = 1 - 0.8F * scene.size.value_or(0.0F);
  const float heat = burns(scene) ? 0.16F : bare * (0.75F * std::exp(-out / 0.7F) + 0.25F * std::exp(-out / 2.6F));
  if (heat < 0.004F) return;
  const float halo = burns(scene) ? 0 : 0.25F;
  const Light glow = heat * Light{2.6F, 0.62F * (0.25F + 0.75F * heat), 0.10F * heat};
  const float radius = 0.62F * candle.wick.width + 0.5F;
  const int reach = static_cast<int>(std::ceil(2.2F * radius));
  const int middle_x = static_cast<int>(candle.wick.end.x);
  const int middle_y = static_cast<int>(candle.wick.end.y + 0.5F * radius);
  for (int y = std::max(0, middle_y - reach); y <= std::min(field.height() - 1, middle_y + reach); ++y) {
    for (int x = std::max(0, middle_x - reach); x <= std::min(field.width() - 1, middle_x + reach); ++x) {
      const float dx = static_cast<float>(x) + 0.5F - candle.wick.end.x;
      const float dy = static_cast<float>(y) + 0.5F - candle.wick.end.y - 0.5F * radius;
      const float near = std::exp(-1.6F * (dx * dx + dy * dy) / (radius * radius));
      // While the flame burns only the wick's own end glows, without a halo beside a leaning flame.
      field.add(x, y, near * (halo + (1 - halo) * wick_at(candle.wick, x, y)) * glow);
    }
  }
}

std::vector<Lamp> lamps_but(std::span<const Candle> candles, std::size_t own) {
  std::vector<Lamp> lamps;
  for (std::size_t k = 0; k < candles.size(); ++k) {
    if (k != own) lamps.push_back(candles[k].lamp);
  }
  return lamps;
}

}  // namespace

FlameStyle clamped(FlameStyle style) {
  style.glow = clamped(style.glow, 0, 4);
  style.glow_reach = clamped(style.glow_reach, 0.25F, 4);
  style.candle_width = clamped(style.candle_width, 0.05F, 4);
  return style;
}

Candle prepared(const Flame& flame, int width, int height) {
  Candle candle;
  candle.scene = clamped(flame.scene);
  const Stage stage = stage_of(candle.scene);
  candle.mood = stage.mood;
  candle.wick = make_wick(candle.scene, width, height);
  if (stage.mood.brightness <= 0) return candle;
  const float cap = std::max(0.03F, 0.55F * kWickGap);
  candle.shape = flame_shape(flame.outline, candle.scene, stage.scale, cap, width, height);
  candle.mood.soot *= sooting(candle.shape);
  candle.lamp = lamp_of(candle.shape, candle.mood);
  return candle;
}

std::array<HaloRing, 4> glow_rings(const FlameStyle& style, float unit) {
  const Light halo = Tone::get().linear(kHalo);
  const Light rim = Tone::get().linear(kRim);
  const float reach = unit * style.glow_reach;
  return {{{0.022F * reach, 0.24F * style.glow * halo},
           {0.085F * reach, 0.17F * style.glow * halo},
           {0.28F * reach, 0.15F * style.glow * halo},
           {0.80F * reach, 0.17F * style.glow * (0.8F * halo + 0.2F * rim)}}};
}

float largest_unit(std::span<const Candle> candles) {
  float unit = 1;
  for (const Candle& candle : candles) unit = std::max(unit, candle.scene.pixels_per_unit);
  return unit;
}

void draw_behind(Image& image, std::span<const Candle> candles, const FlameStyle& style) {
  for (std::size_t k = 0; k < candles.size(); ++k) {
    const Candle& candle = candles[k];
    if (style.candle) draw_candle(image, candle.scene, style, candle.wick, candle.lamp, lamps_but(candles, k));
  }
  const std::vector<Lamp> lamps = lamps_but(candles, candles.size());
  for (const Candle& candle : candles) draw_smoke(image, candle.scene, candle.wick.end, lamps);
}

void add_own_light(LightField& field, const Candle& candle, const FlameStyle& style) {
  add_flame_light(field, candle.shape, candle.mood, style.candle ? wick_shade(candle) : Plane());
  if (style.candle) add_ember(field, candle);
}

}  // namespace wisp::drawing
