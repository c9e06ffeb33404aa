#include <algorithm>
#include <cmath>
#include <vector>

#include "draw/flame/flame_layers.hpp"
#include "draw/tone.hpp"

namespace wisp::drawing {
namespace {

// Aspect ratio (height / width) of the candle's top in the picture, seen from slightly above.
constexpr float kFlatness = 0.17F;

// Position of a candle in pixels.
struct Body {
  float middle = 0;  // x of the axis
  float half = 0;    // half the candle's width
  float top = 0;     // y of the centre of the upper circle
  float bottom = 0;  // y of the centre of the lower circle
  float unit = 0;
  float squash() const { return kFlatness * half; }
};

Body body_of(const FlameScene& scene, const FlameStyle& style) {
  Body body;
  body.unit = scene.pixels_per_unit;
  body.middle = scene.base.x;
  body.half = 0.5F * style.candle_width * body.unit;
  body.top = scene.base.y + kWickGap * body.unit;
  body.bottom = body.top + kCandleHeight * body.unit;
  return body;
}

// A point of the candle in shading coordinates.
struct Spot {
  float across = 0;  // −1 … 1 from the left silhouette to the right
  float facing = 0;  // cosine between surface normal and view direction, 0 … 1
  float depth = 0;   // model units below the rim
  float round = 0;   // on the top: squared distance from the centre, relative to the rim
  float front = 0;   // on the top: −1 far … 1 near
};

// Returns the light that enters the wax at the top and scatters downwards, redder with the distance.
Light seeping(const Spot& spot, const Light& wax, float width, float lean) {
  const float scale = std::sqrt(width / 0.62F);
  const Light way{std::exp(-spot.depth / (0.38F * scale)), std::exp(-spot.depth / (0.22F * scale)),
                  std::exp(-spot.depth / (0.13F * scale))};
  const float lip = 1 + 0.55F * std::exp(-spot.depth / 0.022F);
  const float turned = 0.42F + 0.58F * spot.facing;
  const float sided = 1 + 0.35F * spot.across * lean;
  return 1.10F * lip * turned * sided * (wax * way);
}

// Returns the light from the candle's top: the pool under the flame, and the ridge of wax around the pool.
Light top_light(const Spot& spot, const Light& wax, float lean) {
  const float near_wick = std::exp(-spot.round / 0.22F);
  const float ridge = smooth_step(0.60F, 0.74F, spot.round);
  const float far_side = 0.5F - 0.5F * spot.front;
  const float pool = 0.34F + 0.75F * near_wick;
  const float wall = 0.42F + 0.30F * far_side;
  const float sided = 1 + 0.30F * spot.across * lean;
  const Light wet = (0.35F + 0.65F * near_wick) * wax + (0.65F - 0.65F * near_wick) * (wax * wax);
  const Light base = (1 - ridge) * pool * wet + ridge * wall * wax;
  // The flame mirrored in the pool, towards the eye.
  const float streak = std::exp(-spot.across * spot.across / 0.012F) * smooth_step(0.05F, 0.3F, spot.front) *
                       (1 - smooth_step(0.45F, 0.8F, spot.front));
  return sided * (base + (1 - ridge) * streak * Light{0.55F, 0.42F, 0.22F});
}

// Returns the light of the room on the wax: weak, cool, from the upper left.
Light room_light(const Spot& spot, const Light& wax, float ambient, bool top) {
  const float lit = top ? 0.8F : 0.34F + 0.50F * spot.facing - 0.20F * spot.across;
  return ambient * lit * (wax * Light{0.58F, 0.76F, 1.25F});
}

// Returns the light of a neighbour's flame on the wax, from one side, and around it, since wax is translucent.
Light neighbour_light(const Spot& spot, const Light& wax, const Lamp& lamp, const Body& body) {
  const float dx = (lamp.place.x - body.middle) / body.unit;
  const float dy = (body.top - lamp.place.y) / body.unit + spot.depth;
  const float square = dx * dx + dy * dy;
  const float towards = dx / std::sqrt(square + 0.04F);
  const float wrapped = std::max(0.0F, 0.45F + 0.55F * (spot.across * towards + 0.25F * spot.facing));
  const float strength = 0.11F * lamp.power / (0.35F + square);
  return strength * wrapped * (wax * Light{1.0F, 0.62F, 0.28F});
}

// Wax that ran down the side and set: a runnel with a heavy round end.
struct Drip {
  float across = 0;  // position, as Spot::across
  float half = 0;    // half the width at the end, relative to the candle's half width
  float length = 0;  // model units below the rim
};

std::vector<Drip> drips_of(std::uint64_t seed, float width) {
  std::vector<Drip> drips;
  const int count = 2 + static_cast<int>(2 * random_at(seed, 2));
  for (int k = 0; k < count; ++k) {
    // One drip in each section of the side, so that they do not overlap.
    const float place = (static_cast<float>(k) + 0.2F + 0.6F * random_at(seed, 4 + 3 * k)) / static_cast<float>(count);
    const float half = 0.085F + 0.045F * random_at(seed, 5 + 3 * k);
    const float fall = random_at(seed, 6 + 3 * k);
    drips.push_back({-0.86F + 1.72F * place, half, width * (0.20F + 0.75F * fall * fall)});
  }
  return drips;
}

// Returns the distance of a spot inside the drip's edge, in half widths; negative outside.
float inside_drip(const Drip& drip, const Spot& spot, float half_width) {
  const float up = std::max(0.0F, drip.length - spot.depth) / half_width;
  // A drip is narrower above its end, and wider again at the rim.
  const float neck = 0.62F + 0.38F * std::exp(-up / 0.30F) + 0.9F * std::exp(-spot.depth / (0.10F * half_width));
  const float side = std::abs(spot.across - drip.across) / (drip.half * neck);
  const float below = (spot.depth - (drip.length - drip.half * half_width)) / (drip.half * half_width);
  return 1 - (below > 0 ? std::hypot(side, below) : side);
}

class Shader {
 public:
  Shader(const Body& body, const FlameStyle& style, const Lamp& own, std::span<const Lamp> others, std::uint64_t seed)
      : body_(body),
        style_(style),
        own_(own),
        wax_(Tone::get().linear(style.wax)),
        drips_(drips_of(seed, style.candle_width)),
        pixel_(1 / (0.1F * body.half)) {
    lean_ = std::clamp((own.place.x - body.middle) / (0.5F * body.unit), -1.0F, 1.0F);
    // Farther neighbours change a pixel by less than one 8-bit code.
    for (const Lamp& lamp : others) {
      if (lamp.power > 0 && std::abs(lamp.place.x - body.middle) < 5 * body.unit) near_.push_back(lamp);
    }
  }

  Light body(float x, float y) const {
    Spot spot;
    spot.across = std::clamp((x - body_.middle) / body_.half, -1.0F, 1.0F);
    spot.facing = std::sqrt(1 - spot.across * spot.across);
    spot.depth = std::max(0.0F, (y - body_.top - body_.squash() * spot.facing) / body_.unit);
    Light light = side_light(spot);
    for (const Drip& drip : drips_) {
      const float inside = inside_drip(drip, spot, 0.5F * style_.candle_width);
      if (inside < -1) continue;
      // The side is shaded beside a drip; on the drip the surface is convex again from left to right.
      const float shade = 0.16F * smooth_step(-0.9F, 0, inside);
      light = (1 - shade) * light;
      const float on = std::clamp(0.5F + inside / pixel_, 0.0F, 1.0F);
      if (on > 0) light = (1 - on) * light + on * drip_light(drip, spot, inside);
    }
    return light;
  }

  Light top(float x, float y) const {
    Spot spot;
    spot.across = (x - body_.middle) / body_.half;
    spot.front = (y - body_.top) / body_.squash();
    spot.round = spot.across * spot.across + spot.front * spot.front;
    spot.facing = 0.6F;
    Light light = room_light(spot, wax_, kAmbient, true) + own_.power * (flame_tint() * top_light(spot, wax_, lean_));
    for (const Lamp& lamp : near_) light = light + 0.8F * neighbour_light(spot, wax_, lamp, body_);
    return light;
  }

 private:
  // Returns the light of the flame that wall and table reflect.
  Light bounced(const Spot& spot) const { return (0.05F + 0.035F * (1 - spot.facing)) * wax_; }

  Light side_light(const Spot& spot) const {
    Light light = room_light(spot, wax_, kAmbient, false) +
                  own_.power * (flame_tint() * (seeping(spot, wax_, style_.candle_width, lean_) + bounced(spot)));
    for (const Lamp& lamp : near_) light = light + neighbour_light(spot, wax_, lamp, body_);
    return light;
  }

  Light drip_light(const Drip& drip, const Spot& spot, float inside) const {
    Spot bent = spot;
    const float turn = std::clamp((spot.across - drip.across) / drip.half, -1.0F, 1.0F);
    bent.across = std::clamp(spot.across + 0.35F * turn, -1.0F, 1.0F);
    bent.facing = std::min(1.0F, 0.75F * spot.facing + 0.35F * std::min(1.0F, inside));
    // Protruding wax catches more of the light from the rim.
    bent.depth = 0.86F * spot.depth;
    return 1.06F * side_light(bent);
  }

  static Light flame_tint() { return {1.0F, 0.70F, 0.36F}; }

  Body body_;
  FlameStyle style_;
  Lamp own_;
  Light wax_;
  std::vector<Drip> drips_;
  float pixel_;  // size of a pixel in half widths of a drip
  float lean_ = 0;
  std::vector<Lamp> near_;
};

// Returns the approximate signed distance in pixels, positive inside an ellipse centred at the origin.
float inside_ellipse(float x, float y, float half, float squash) {
  const float u = x / half;
  const float v = y / squash;
  const float level = u * u + v * v;
  const float slope = 2 * std::sqrt(u * u / (half * half) + v * v / (squash * squash));
  return slope > 0 ? (1 - level) / slope : squash;
}

float covered(float distance) { return std::clamp(distance + 0.5F, 0.0F, 1.0F); }

void draw_wax(Image& image, const Body& body, const Shader& shader) {
  const float squash = body.squash();
  const int left = std::max(0, static_cast<int>(std::floor(body.middle - body.half)) - 1);
  const int right = std::min(image.width(), static_cast<int>(std::ceil(body.middle + body.half)) + 1);
  const int top = std::max(0, static_cast<int>(std::floor(body.top - squash)) - 1);
  const int bottom = std::min(image.height(), static_cast<int>(std::ceil(body.bottom + squash)) + 1);
  for (int row = top; row < bottom; ++row) {
    const float y = static_cast<float>(row) + 0.5F;
    const auto pixels = image.row(row);
    for (int column = left; column < right; ++column) {
      const float x = static_cast<float>(column) + 0.5F;
      const float upper = covered(inside_ellipse(x - body.middle, y - body.top, body.half, squash));
      const float lower = covered(inside_ellipse(x - body.middle, y - body.bottom, body.half, squash));
      const float side = covered(body.half - std::abs(x - body.middle));
      const bool between = y >= body.top && y <= body.bottom;
      const float solid = std::max({upper, between ? side : 0.0F, y > body.bottom ? lower : 0.0F});
      if (solid <= 0) continue;
      Light light;
      if (upper < 1) light = light + (1 - upper) * shader.body(x, y);
      if (upper > 0) light = light + upper * shader.top(x, y);
      blend(pixels[column], light, solid, dither_at(column, row));
    }
  }
}

void draw_wick(Image& image, const Wick& wick, const Lamp& own, float ambient) {
  const float length = std::max(1.0F, wick.root.y - wick.end.y);
  for (int row = 0; row < wick.box.height; ++row) {
    const int y = wick.box.y + row;
    // The wick is soaked with wax below and charred above.
    const float charred = smooth_step(0.15F, 0.55F, (wick.root.y - static_cast<float>(y)) / length);
    const float power = own.power + ambient;
    const Light soaked = 0.09F * power * Light{1.0F, 0.52F, 0.22F};
    const Light char_light = Light{0.006F, 0.005F, 0.005F} + 0.012F * power * Light{1.0F, 0.5F, 0.2F};
    const Light light = (1 - charred) * soaked + charred * char_light;
    for (int column = 0; column < wick.box.width; ++column) {
      const float solid = wick.coverage.row(row)[column];
      const int x = wick.box.x + column;
      if (solid > 0) blend(image.row(y)[x], light, solid, dither_at(x, y));
    }
  }
}

}  // namespace

Wick make_wick(const FlameScene& scene, int width, int height) {
  Wick wick;
  const float unit = scene.pixels_per_unit;
  const float length = kWickHeight * unit;
  wick.width = 0.032F * unit;
  wick.root = {scene.base.x, scene.base.y + kWickGap * unit};
  // Wicks curl over as they burn, in a random direction.
  const float bend = (random_at(scene.seed, 0) < 0.5F ? -1.0F : 1.0F) * (0.16F + 0.16F * random_at(scene.seed, 1));
  constexpr int kSteps = 14;
  std::vector<Point> left;
  std::vector<Point> right;
  for (int k = 0; k <= kSteps; ++k) {
    const float s = static_cast<float>(k) / kSteps;
    const Point p{wick.root.x + bend * length * s * s, wick.root.y - length * s};
    const float half = 0.5F * wick.width * (1 - 0.42F * s) * (k == kSteps ? 0.55F : 1.0F);
    const float slope = 2 * bend * s;
    const float norm = std::sqrt(1 + slope * slope);
    left.push_back({p.x - half / norm, p.y - half * slope / norm});
    right.push_back({p.x + half / norm, p.y + half * slope / norm});
    wick.end = p;
  }
  left.insert(left.end(), right.rbegin(), right.rend());
  wick.box = visible_box(bounds_of(left), 0, width, height);
  if (wick.empty()) return wick;
  for (Point& p : left) p = {p.x - static_cast<float>(wick.box.x), p.y - static_cast<float>(wick.box.y)};
  wick.coverage = coverage_of(left, wick.box.width, wick.box.height, false);
  return wick;
}

float wick_at(const Wick& wick, int x, int y) {
  const int column = x - wick.box.x;
  const int row = y - wick.box.y;
  if (column < 0 || row < 0 || column >= wick.box.width || row >= wick.box.height) return 0;
  return wick.coverage.row(row)[column];
}

void draw_candle(Image& image, const FlameScene& scene, const FlameStyle& style, const Wick& wick, const Lamp& own,
                 std::span<const Lamp> others) {
  const Body body = body_of(scene, style);
  draw_wax(image, body, Shader(body, style, own, others, scene.seed));
  draw_wick(image, wick, own, kAmbient);
}

}  // namespace wisp::drawing
