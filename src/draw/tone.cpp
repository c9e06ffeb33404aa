#include "draw/tone.hpp"

namespace wisp::drawing {
namespace {

float srgb_decoded(float code) { return code <= 0.04045F ? code / 12.92F : std::pow((code + 0.055F) / 1.055F, 2.4F); }

float srgb_encoded(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1 / 2.4F) - 0.055F;
}

}  // namespace

Tone::Tone() {
  for (std::size_t code = 0; code < linear_.size(); ++code)
    linear_[code] = srgb_decoded(static_cast<float>(code) / 255);
  for (std::size_t k = 0; k < code_.size(); ++k) {
    const float root = static_cast<float>(k) / kSteps;
    code_[k] = 255 * srgb_encoded(root * root);
  }
}

const Tone& Tone::get() {
  static const Tone tone;
  return tone;
}

Light emission_of(Colour colour) {
  // Linear values are limited to below 1, as white itself would need infinite light.
  const auto emission = [](float linear) { return -std::log1p(-std::min(linear, 0.95F)); };
  const Light light = Tone::get().linear(colour);
  return {emission(light.red), emission(light.green), emission(light.blue)};
}

void blend(std::uint32_t& pixel, Light light, float opacity, float dither) {
  const Tone& tone = Tone::get();
  const auto mixed = [&](int shift, float channel) {
    const float there = tone.linear(pixel >> shift & 0xFFU);
    return dithered(tone.code(there + opacity * (std::min(channel, 1.0F) - there)), dither);
  };
  const std::uint32_t r = mixed(16, light.red);
  const std::uint32_t g = mixed(8, light.green);
  const std::uint32_t b = mixed(0, light.blue);
  const auto solid = static_cast<std::uint32_t>(std::lround(255 * opacity));
  const std::uint32_t alpha = std::max({pixel >> 24, solid, r, g, b});
  pixel = alpha << 24 | r << 16 | g << 8 | b;
}

}  // namespace wisp::drawing
