#pragma once
// What a picture of candles is made of, layer by layer, before light is shown: for pictures of any kind and speed.

#include <array>
#include <span>

#include "draw/flame/candle.hpp"
#include "draw/flame/flame_light.hpp"
#include "draw/flame/flame_shape.hpp"
#include "draw/flame/light_field.hpp"
#include "draw/flame/wick.hpp"

namespace wisp::drawing {

/// All that is known of one candle before anything is drawn.
struct Candle {
  FlameScene scene;
  FlameShape shape;
  FlameMood mood;
  Wick wick;
  Lamp lamp;
};

/// A style with its fields in their ranges.
FlameStyle held(FlameStyle style);

/// Lays a flame over a picture of that size. Precondition: the style is in its ranges.
Candle prepared(const Flame& flame, const FlameStyle& style, int width, int height);

/// The flame as others see it, without laying it over a picture.
Lamp lamp_of(const Flame& flame);

/// Model units of the largest of them in pixels, at least 1.
float largest_unit(std::span<const Candle> candles);

/// Draws every candle, lit by all flames, then all smoke.
void draw_behind(Image& image, std::span<const Candle> candles, const FlameStyle& style);

/// Adds the light of a flame, its wick before it, or of the ember that is left of it.
void add_own_light(LightField& field, const Candle& candle, const FlameStyle& style);

/// The rings of the glow around flames whose model unit is that many pixels.
std::array<HaloRing, 4> glow_rings(const FlameStyle& style, float unit);

}  // namespace wisp::drawing
