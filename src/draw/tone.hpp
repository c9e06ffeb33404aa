#pragma once
// Conversion between 8-bit sRGB and linear light.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "wisp/draw/image.hpp"

namespace wisp::drawing {

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

/// The sRGB transfer function in both directions, as tables. Callers get() it once for many pixels.
class Tone {
 public:
  static const Tone& get();

  /// Returns the linear value of an 8-bit channel, 0 … 1.
  float linear(std::uint32_t channel) const { return linear_[channel]; }
  Light linear(Colour colour) const { return {linear_[colour.red], linear_[colour.green], linear_[colour.blue]}; }

  /// Returns the fractional sRGB code, 0 … 255, of a linear value; accurate to 0.004.
  float code(float linear_value) const {
    const float at = std::sqrt(std::clamp(linear_value, 0.0F, 1.0F)) * kSteps;
    const int k = static_cast<int>(at);
    return code_[k] + (at - static_cast<float>(k)) * (code_[k + 1] - code_[k]);
  }

 private:
  Tone();

  // Codes tabulated over the square root of the linear value, where the curve is nearly linear.
  static constexpr int kSteps = 1024;
  std::array<float, 256> linear_{};
  std::array<float, kSteps + 2> code_{};
};

/// Rounds a fractional code with dithering: up where the fraction exceeds 1 − `dither`, which is in [0, 1). Codes that
/// are whole up to the table's error stay unchanged.
inline std::uint32_t dithered(float code, float dither) {
  constexpr float kTableError = 0.004F;
  return static_cast<std::uint32_t>(std::min(255.0F, code + dither * (1 - 2 * kTableError) + kTableError));
}

/// Returns noise in [0, 1), the same in every frame so that video does not flicker: interleaved gradient noise (J.
/// Jimenez, Next Generation Post Processing in Call of Duty: Advanced Warfare, SIGGRAPH 2014) in fixed point.
inline float dither_at(int x, int y) {
  const std::uint32_t along = static_cast<std::uint32_t>(x) * 288237660U + static_cast<std::uint32_t>(y) * 25070368U;
  const auto spread = static_cast<std::uint32_t>(static_cast<std::uint64_t>(along) * 888907844U >> 24);
  return static_cast<float>(spread >> 8) / 16777216.0F;
}

/// Returns a pixel's offset for dithering in bulk: a fractional code plus the offset, truncated, equals dithered().
inline float rounding_at(int x, int y) { return 0.004F + 0.992F * dither_at(x, y); }

/// Returns the light that add_light() renders as `colour` on black.
Light emission_of(Colour colour);

/// Blends a surface with that light over a premultiplied pixel, `opacity` 0 … 1.
void blend(std::uint32_t& pixel, Light light, float opacity, float dither);

/// Returns 0 below `low`, 1 above `high`, and a smooth transition between.
inline float smooth_step(float low, float high, float value) {
  const float t = std::clamp((value - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

}  // namespace wisp::drawing
