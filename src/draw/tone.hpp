#pragma once
// Between the 8-bit sRGB of pictures and linear light.

#include <cstdint>

#include "wisp/draw/image.hpp"

namespace wisp {

/// Linear light or reflectance in sRGB's primaries; 1 is the picture's white.
struct Light {
  float red = 0;
  float green = 0;
  float blue = 0;

  friend Light operator+(Light a, Light b) { return {a.red + b.red, a.green + b.green, a.blue + b.blue}; }
  friend Light operator*(Light a, Light b) { return {a.red * b.red, a.green * b.green, a.blue * b.blue}; }
  friend Light operator*(float s, Light a) { return {s * a.red, s * a.green, s * a.blue}; }
};

inline float luminance(Light light) { return 0.2126F * light.red + 0.7152F * light.green + 0.0722F * light.blue; }

/// Linear value of an 8-bit sRGB channel, 0 … 1.
float linear_of(std::uint8_t channel);
Light linear_of(Colour colour);

/// The emission that add_light() shows as that colour on black.
Light emission_of(Colour colour);

/// 8-bit sRGB of a linear value. `dither` in [0, 1) decides how fractions of a code are rounded; a value that is a
/// code exactly stays that code.
std::uint8_t encoded(float linear, float dither);

/// Lays a surface that sends that light over a premultiplied pixel, `opacity` 0 … 1.
void blend(std::uint32_t& pixel, Light light, float opacity, float dither);

/// Ordered noise in [0, 1) that spreads rounding over neighbouring pixels (J. Jimenez, Next Generation Post Processing
/// in Call of Duty: Advanced Warfare, SIGGRAPH 2014). The same for every frame, so that video does not boil.
float dither_at(int x, int y);

/// 0 below `low`, 1 above `high`, smooth between.
float smooth_step(float low, float high, float value);

}  // namespace wisp
