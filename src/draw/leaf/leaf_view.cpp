#include "draw/leaf/leaf_view.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "draw/tone.hpp"

namespace wisp::drawing {

Turn::Turn(const std::array<float, 4>& q) {
  const float two = 2 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const float w = q[0], x = q[1], y = q[2], z = q[3];
  x_ = {1 - two * (y * y + z * z), two * (x * y + w * z), two * (x * z - w * y)};
  y_ = {two * (x * y - w * z), 1 - two * (x * x + z * z), two * (y * z + w * x)};
  z_ = {two * (x * z + w * y), two * (y * z - w * x), 1 - two * (x * x + y * y)};
}

LeafView::LeafView(const LeafCamera& camera, int width, int height) : eye_(vec3(camera.eye)) {
  const Vec3 way = vec3(camera.target) - eye_;
  const float distance = std::max(length(way), kNear);
  forward_ = 1 / distance * way;
  // Looking straight down or up, the y axis points up in the picture.
  const bool steep = std::abs(forward_.z) > 0.999F;
  right_ = unit(cross(forward_, steep ? Vec3{0, 1, 0} : Vec3{0, 0, 1}));
  up_ = cross(right_, forward_);
  focal_ = static_cast<float>(height) / std::clamp(camera.view_height, 0.01F, 1000.0F) * distance;
  middle_x_ = static_cast<float>(width) / 2;
  middle_y_ = static_cast<float>(height) / 2;
}

Projected LeafView::operator()(Vec3 place) const {
  const Vec3 way = place - eye_;
  const float depth = dot(way, forward_);
  const float scale = focal_ / std::max(depth, kNear);
  return {middle_x_ + scale * dot(way, right_), middle_y_ - scale * dot(way, up_), depth};
}

Vec3 LeafView::ray(float x, float y) const {
  return forward_ + (x - middle_x_) / focal_ * right_ + (middle_y_ - y) / focal_ * up_;
}

namespace {

constexpr Light kLamp{1.25F, 1.18F, 1.06F};
constexpr Light kSky{0.42F, 0.45F, 0.50F};
constexpr float kDimmed = 0.6F;  // factor of the leaf's colour, as lamp and sky together exceed white
constexpr float kShine = 0.09F;  // specular share of the lamp's light on the upper side
constexpr int kTeeth = 19;
constexpr float kStalk = 0.24F;               // length of the stalk, as a share of the blade's length
constexpr float kStalkWidth = 0.016F;         // width of the stalk, as a share of the blade's length
constexpr int kLeafRows = 120, kSamples = 4;  // rows of the picture; samples per pixel along each side

Light mixed(Light a, Light b, float share) { return (1 - share) * a + share * b; }

// Returns the share of vein in the colour at a position, 0 … 1.
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

// Returns the blotches of an autumn leaf, −1 … 1: a sum of a few waves that do not repeat within the leaf.
float blotch(float u, float v) {
  return (std::sin(9.1F * u + 3.7F * v + 0.4F) + std::sin(-5.3F * u + 7.9F * v + 1.9F) +
          std::sin(14.2F * u - 4.4F * v + 4.1F)) /
         3;
}

// Returns the blade's half width as a share of the style's: rounded at the base, drawn out at the tip.
float half_width(float u) {
  const float base = std::pow(u, 0.62F), tip = std::pow(1 - u, 0.95F);
  constexpr float kWidest = 0.4527F;  // 1.3 times the product's maximum, which is at u = 0.62 / 1.57
  return std::min(1.0F, base * tip / (kWidest * (0.75F + 0.25F * std::min(1.0F, (1 - u) * 5))));
}

// A position on a leaf: along the midrib, 0 base … 1 tip (below 0: the stalk), and across, −1 … 1.
struct LeafPlace {
  float u = 0, v = 0;
};

// Returns the place on the leaf at x, y (halves of blade length and width), if any; `slim`: the blade's width / length.
std::optional<LeafPlace> place_at(float x, float y, float slim) {
  const float u = (x + 1) / 2;
  if (u >= 0) {
    const float v = y / half_width(std::min(u, 1.0F));
    // Teeth point to the tip: each rises slowly and drops steeply.
    const float tooth = u * kTeeth - std::floor(u * kTeeth);
    if (u > 1 || !(std::abs(v) <= 1 - 0.045F * (1 - tooth))) return {};
    return LeafPlace{u, v};
  }
  const float s = -u / kStalk, v = (y * slim - 0.06F * s * s) / (kStalkWidth * (1 + 0.6F * s * s));
  if (s > 1 || std::abs(v) > 1) return {};
  return LeafPlace{-s, v};
}

struct LeafColours {
  Light upper, margin, under, vein;

  Light at(LeafPlace place, bool above) const {
    const auto [u, v] = place;
    if (u < 0) return mixed(vein, margin, 0.45F);
    const float edge = smooth_step(0.25F, 1.05F, std::abs(v) + 0.35F * std::abs(u - 0.45F) + 0.14F * blotch(u, v));
    const float veined = vein_at(u, v);
    if (above) return mixed(mixed(upper, margin, edge), vein, 0.75F * veined);
    // On the lower side veins are raised, and the other side's colour shows through faintly.
    return mixed(mixed(under, mixed(upper, margin, edge), 0.20F + 0.22F * edge), 0.55F * mixed(under, margin, 0.35F),
                 0.8F * veined);
  }
};

}  // namespace

Texture painted_side(const LeafStyle& style, bool upper) {
  const Tone& tone = Tone::get();
  const LeafColours colours{tone.linear(style.upper), tone.linear(style.margin), tone.linear(style.under),
                            tone.linear(style.vein)};
  const float slim = style.width / style.length;
  Texture::Level picture{kLeafPixels, kLeafRows, {}};
  for (int pixel = 0; pixel < kLeafPixels * kLeafRows; ++pixel) {
    Light sum;
    float count = 0;
    for (int sample = 0; sample < kSamples * kSamples; ++sample) {
      const auto share = [](int place, int part, int of) {
        return (static_cast<float>(place) + (static_cast<float>(part) + 0.5F) / kSamples) / static_cast<float>(of);
      };
      const float right = share(pixel % kLeafPixels, sample % kSamples, kLeafPixels);
      const float down = share(pixel / kLeafPixels, sample / kSamples, kLeafRows);
      const auto place = place_at(kLeafLeft + right * (kLeafRight - kLeafLeft), kLeafSide * (1 - 2 * down), slim);
      if (!place) continue;
      sum = sum + colours.at(*place, upper) * (kLamp + kSky) + (upper ? kShine : 0) * kLamp;
      ++count;
    }
    const float cover = count / (kSamples * kSamples);
    const Light light = kDimmed / std::max(count, 1.0F) * sum;
    const auto code = [&](float value) { return static_cast<std::uint32_t>(cover * tone.code(value) + 0.5F); };
    picture.pixels.push_back(static_cast<std::uint32_t>(255 * cover + 0.5F) << 24 | code(light.red) << 16 |
                             code(light.green) << 8 | code(light.blue));
  }
  return texture_of(std::move(picture));
}

}  // namespace wisp::drawing
