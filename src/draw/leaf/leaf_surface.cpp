#include "draw/leaf/leaf_surface.hpp"

#include <algorithm>

namespace wisp::drawing {
namespace {

constexpr Light kLamp{1.25F, 1.18F, 1.06F};
constexpr Light kSky{0.42F, 0.45F, 0.50F};
constexpr Light kFloor{0.30F, 0.27F, 0.23F};

Light mixed(Light a, Light b, float share) { return (1 - share) * a + share * b; }

// How much of a place is vein, 0 … 1.
float vein_at(float u, float v) {
  const float across = std::abs(v);
  const float midrib = 1 - smooth_step(0.6F, 1.0F, across / (0.075F - 0.055F * u));
  // Veins leave the midrib at an angle and bend to the tip.
  constexpr float kVeins = 9;
  const float at = (u - 0.24F * across - 0.06F * across * across) * kVeins;
  const float from_vein = std::abs(at - std::round(at));
  const bool there = at > 0.4F && at < kVeins - 0.7F;
  const float width = 0.10F * (1 - 0.65F * across);
  const float side =
      there ? (1 - smooth_step(0.45F, 1.0F, from_vein / width)) * (1 - smooth_step(0.75F, 1, across)) : 0;
  return std::max(midrib, 0.62F * side);
}

// Blotches of a leaf that is past its summer, −1 … 1: a few waves that do not repeat within it.
float blotch(float u, float v) {
  return (std::sin(9.1F * u + 3.7F * v + 0.4F) + std::sin(-5.3F * u + 7.9F * v + 1.9F) +
          std::sin(14.2F * u - 4.4F * v + 4.1F)) /
         3;
}

}  // namespace

LeafSurface::LeafSurface(const LeafStyle& style, Vec3 towards_lamp) : lamp_(towards_lamp) {
  const Tone& tone = Tone::get();
  upper_ = tone.linear(style.upper);
  margin_ = tone.linear(style.margin);
  under_ = tone.linear(style.under);
  vein_ = tone.linear(style.vein);
}

Light LeafSurface::reflectance(float u, float v, bool upper) const {
  if (u < 0) return mixed(vein_, margin_, 0.45F);
  const float edge = smooth_step(0.25F, 1.05F, std::abs(v) + 0.35F * std::abs(u - 0.45F) + 0.14F * blotch(u, v));
  const float vein = vein_at(u, v);
  if (upper) return mixed(mixed(upper_, margin_, edge), vein_, 0.75F * vein);
  // Below, veins stand out as ridges and the colour of the other side shows faintly.
  return mixed(mixed(under_, mixed(upper_, margin_, edge), 0.20F + 0.22F * edge), 0.55F * mixed(under_, margin_, 0.35F),
               0.8F * vein);
}

Light LeafSurface::seen(float u, float v, Vec3 normal, Vec3 to_eye) const {
  const bool upper = dot(normal, to_eye) >= 0;
  const Vec3 facing = upper ? normal : -1.0F * normal;
  const Light own = reflectance(u, v, upper);
  const float falls = dot(facing, lamp_);
  const float sky = 0.5F + 0.5F * facing.z;
  Light light = own * (std::max(falls, 0.0F) * kLamp + sky * kSky + (1 - sky) * kFloor);
  // What falls on the far side comes through, warmer by what the leaf has swallowed.
  if (falls < 0) {
    const Light through = mixed(upper_, margin_, 0.35F);
    light = light + (-falls * 0.3F * (1 - 0.7F * vein_at(u, v))) * (through * kLamp);
  }
  if (!upper) return light;
  const float shine = dot(facing, unit(lamp_ + to_eye));
  const float spot = std::pow(std::max(shine, 0.0F), 28.0F);
  return light + (0.09F * spot) * kLamp;
}

}  // namespace wisp::drawing
