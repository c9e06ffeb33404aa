#include "draw/tone.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace wisp {
namespace {

float srgb_decoded(float code) { return code <= 0.04045F ? code / 12.92F : std::pow((code + 0.055F) / 1.055F, 2.4F); }

float srgb_encoded(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1 / 2.4F) - 0.055F;
}

std::array<float, 256> decoding_table() {
  std::array<float, 256> table{};
  for (std::size_t code = 0; code < table.size(); ++code) table[code] = srgb_decoded(static_cast<float>(code) / 255);
  return table;
}

// Codes over the square root of the linear value, where the curve is nearly straight: linear interpolation between
// 1024 entries is within 0.002 codes, also in the darks.
constexpr int kEncodingSteps = 1024;

std::array<float, kEncodingSteps + 2> encoding_table() {
  std::array<float, kEncodingSteps + 2> table{};
  for (std::size_t k = 0; k < table.size(); ++k) {
    const float root = static_cast<float>(k) / kEncodingSteps;
    table[k] = 255 * srgb_encoded(root * root);
  }
  return table;
}

}  // namespace

float linear_of(std::uint8_t channel) {
  static const std::array<float, 256> table = decoding_table();
  return table[channel];
}

Light linear_of(Colour colour) { return {linear_of(colour.red), linear_of(colour.green), linear_of(colour.blue)}; }

Light emission_of(Colour colour) {
  // White itself would take endless light.
  const auto emission = [](std::uint8_t channel) { return -std::log1p(-std::min(linear_of(channel), 0.95F)); };
  return {emission(colour.red), emission(colour.green), emission(colour.blue)};
}

std::uint8_t encoded(float linear, float dither) {
  static const std::array<float, kEncodingSteps + 2> table = encoding_table();
  const float at = std::sqrt(std::clamp(linear, 0.0F, 1.0F)) * kEncodingSteps;
  const int k = static_cast<int>(at);
  const float code = table[k] + (at - static_cast<float>(k)) * (table[k + 1] - table[k]);
  // The table's own error must not turn an exact code into the one below.
  constexpr float kTableError = 0.004F;
  return static_cast<std::uint8_t>(std::min(255.0F, code + dither * (1 - 2 * kTableError) + kTableError));
}

void blend(std::uint32_t& pixel, Light light, float opacity, float dither) {
  const auto mixed = [&](int shift, float channel) -> std::uint32_t {
    const float there = linear_of(static_cast<std::uint8_t>(pixel >> shift & 0xFFU));
    return encoded(there + opacity * (std::min(channel, 1.0F) - there), dither);
  };
  const std::uint32_t r = mixed(16, light.red);
  const std::uint32_t g = mixed(8, light.green);
  const std::uint32_t b = mixed(0, light.blue);
  const auto solid = static_cast<std::uint32_t>(std::lround(255 * opacity));
  const std::uint32_t alpha = std::max({pixel >> 24, solid, r, g, b});
  pixel = alpha << 24 | r << 16 | g << 8 | b;
}

float dither_at(int x, int y) {
  const float along = 0.06711056F * static_cast<float>(x) + 0.00583715F * static_cast<float>(y);
  const float spread = 52.9829189F * (along - std::floor(along));
  return spread - std::floor(spread);
}

float smooth_step(float low, float high, float value) {
  const float t = std::clamp((value - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

}  // namespace wisp
