// The shape of a flame in a picture: which pixels it covers, and how thick the glowing body is behind each.
//
// The flame is a body of revolution. Where its half width is w, the chord of light at distance d from the edge is
// 2 √(d (2w − d)); and in a long strip φ = d (2w − d) / 2 solves ∇²φ = −1 with φ = 0 at the edge. So half the chord is
// √(2φ) with φ solved inside the outline, whatever its shape. It is smooth and moves as smoothly as the outline.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "draw/cairo.hpp"
#include "draw/flame/flame_layers.hpp"
#include "draw/random.hpp"

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
  scene.brightness = clamped(scene.brightness, 0, 4);
  scene.seconds_since_lit = clamped(scene.seconds_since_lit, 0, kLongAgo);
  scene.seconds_since_out = clamped(scene.seconds_since_out, 0, kLongAgo);
  if (scene.size) scene.size = clamped(*scene.size, 0, 1);
  scene.wind = clamped(scene.wind, -8, 8);
  return scene;
}

// Scale of the outline and light of a growing or shrinking flame.
struct Stage {
  float scale = 1;
  FlameMood mood;
};

// Mood of a flame that has grown to the share `grown`.
FlameMood re_igniting(float brightness, float grown) {
  return {brightness * (0.5F + 0.5F * grown), 0.25F + 0.75F * smooth_step(0.15F, 0.9F, grown)};
}

Stage stage_of(const FlameScene& scene) {
  Stage stage;
  if (burns(scene)) {
    const float grown = scene.size.value_or(smooth_step(0, kReIgnition, scene.seconds_since_lit));
    stage.mood = re_igniting(scene.brightness, grown);
    if (!scene.size) stage.scale = 0.22F + 0.78F * grown;
    return stage;
  }
  const float gone = 1 - scene.size.value_or(1 - smooth_step(0, kDecay, scene.seconds_since_out));
  stage.mood = {scene.brightness * (1 - gone), 1 - gone};
  if (!scene.size) stage.scale = 1 - 0.55F * gone;
  return stage;
}

// A very small flame burns blue.
float sooting(const FlameShape& shape) { return smooth_step(0.06F, 0.40F, shape.height); }

Lamp lamp_of(const FlameShape& shape, const FlameMood& mood) {
  const float area = std::min(3.0F, shape.area / kCalmArea);
  const float glowing = mood.brightness * (0.06F + 0.94F * mood.soot);
  return {shape.middle, glowing * std::pow(area, 0.7F)};
}

// Light as a function of the glowing soot in view (0 none … 1 the thickest part): rim, body and core with soft
// transitions.
class SootRamp {
 public:
  explicit SootRamp(const FlameStyle& style) {
    const Light rim = emission_of(style.rim);
    const Light body = emission_of(style.body);
    const Light core = emission_of(style.core);
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

// Share of glowing soot at the share t of the way from base to tip: the dark zone around the wick, the luminous zone,
// and the tip where soot burns off.
float soot_profile(float t) {
  const float rise = 0.04F + 0.34F * smooth_step(0.04F, 0.22F, t) + 0.62F * smooth_step(0.14F, 0.44F, t);
  const float burn_off = 1 - 0.55F * smooth_step(0.74F, 1.04F, t);
  return rise * burn_off;
}

// Depth of soot: the whole flame above, only the inside of the blue mantle below, which soot would turn purple.
float soot_depth(float t, float thick) {
  const float shell = 0.50F * (1 - smooth_step(0.05F, 0.34F, t));
  return std::max(0.0F, thick - shell) / (1 - shell);
}

// The blue mantle: a thin shell of burning gas, seen edge-on at the sides, that fades upwards.
float mantle(float t, float thick) {
  const float shell = std::exp(-7.0F * thick * thick) + 0.05F;
  return shell * (1 - smooth_step(0.00F, 0.27F, t));
}

// Adds the flame's light to the field. `shade` dims it where the wick stands in it, 0 … 1, over the shape's box; an
// empty plane dims nothing.
void add_flame_light(LightField& field, const FlameShape& shape, const FlameMood& mood, const FlameStyle& style,
                     const Plane& shade) {
  if (shape.empty() || shape.thickest <= 0) return;
  const SootRamp ramp(style);
  const Light blue = emission_of(style.base);
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

// The wick hides most of the flame's light, since the gas before it is thin.
Plane wick_shade(const Candle& candle) {
  constexpr float kHides = 0.82F;
  const PixelBox& box = candle.shape.box;
  Plane shade(box.width, box.height);
  for (int y = 0; y < box.height; ++y) {
    for (int x = 0; x < box.width; ++x) shade.row(y)[x] = kHides * wick_at(candle.wick, box.x + x, box.y + y);
  }
  return shade;
}

// The glowing end of the wick: hidden by the burning flame, fading for seconds after extinction.
void add_ember(LightField& field, const Candle& candle) {
  const FlameScene& scene = candle.scene;
  if (candle.wick.empty() || (burns(scene) && candle.shape.empty())) return;
  const float out = scene.seconds_since_out;
  // It becomes visible as the flame shrinks.
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
  style.exposure = clamped(style.exposure, 0, 8);
  style.glow = clamped(style.glow, 0, 4);
  style.glow_reach = clamped(style.glow_reach, 0.25F, 4);
  style.candle_width = clamped(style.candle_width, 0.05F, 4);
  style.candle_height = clamped(style.candle_height, 0.05F, 20);
  style.wick_gap = clamped(style.wick_gap, 0, 1);
  style.wick_height = clamped(style.wick_height, 0, 1);
  style.ambient = clamped(style.ambient, 0, 1);
  return style;
}

Candle prepared(const Flame& flame, const FlameStyle& style, int width, int height) {
  Candle candle;
  candle.scene = clamped(flame.scene);
  const Stage stage = stage_of(candle.scene);
  candle.mood = stage.mood;
  candle.wick = make_wick(candle.scene, style, width, height);
  if (stage.mood.brightness <= 0) return candle;
  const float cap = std::max(0.03F, 0.55F * style.wick_gap);
  candle.shape = flame_shape(flame.outline, candle.scene, stage.scale, cap, width, height);
  candle.mood.soot *= sooting(candle.shape);
  candle.lamp = lamp_of(candle.shape, candle.mood);
  return candle;
}

Lamp lamp_of(const Flame& flame) {
  const FlameScene scene = clamped(flame.scene);
  Stage stage = stage_of(scene);
  if (stage.mood.brightness <= 0) return {};
  const FlameShape shape = measured_shape(flame.outline, scene, stage.scale);
  stage.mood.soot *= sooting(shape);
  return lamp_of(shape, stage.mood);
}

std::array<HaloRing, 4> glow_rings(const FlameStyle& style, float unit) {
  const Light halo = Tone::get().linear(style.halo);
  const Light rim = Tone::get().linear(style.rim);
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
  add_flame_light(field, candle.shape, candle.mood, style, style.candle ? wick_shade(candle) : Plane());
  if (style.candle) add_ember(field, candle);
}

namespace {

// Limit of a flame's size in model units, which bounds memory for absurd outlines.
constexpr float kFarthest = 8;

// Resolution of the grid for φ: about a hundredth of the flame, at most a pixel.
constexpr float kCellsPerUnit = 96;
constexpr int kMaxCells = 240;

struct Bounds {
  float left = 0, top = 0, right = 0, bottom = 0;
  float width() const { return right - left; }
  float height() const { return bottom - top; }
};

std::vector<Point> finite_points(std::span<const Point> outline) {
  std::vector<Point> points;
  points.reserve(outline.size() + 1);
  for (const Point p : outline) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y)) continue;
    points.push_back({std::clamp(p.x, -kFarthest, kFarthest), std::clamp(p.y, -kFarthest, kFarthest)});
  }
  return points;
}

float area_of(std::span<const Point> points) {
  float twice = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point a = points[k];
    const Point b = points[(k + 1) % points.size()];
    twice += a.x * b.y - b.x * a.y;
  }
  return std::abs(twice) / 2;
}

Bounds bounds_of(std::span<const Point> points) {
  Bounds b{points[0].x, points[0].y, points[0].x, points[0].y};
  for (const Point p : points) {
    b.left = std::min(b.left, p.x);
    b.right = std::max(b.right, p.x);
    b.top = std::min(b.top, p.y);
    b.bottom = std::max(b.bottom, p.y);
  }
  return b;
}

// Junction of one side of the flame with its rounded base.
struct Shoulder {
  std::ptrdiff_t rest = 0;  // points of the outline's end that the base replaces
  Point at;
  Point way;  // unit direction of the side there
};

// Follows the outline from one of its ends to where it first rises through `height`. Where that is not near the end (a
// flame blown flat), the end itself is the shoulder.
template <class Points>
Shoulder shoulder_of(const Points& begin, std::ptrdiff_t size, float height) {
  Shoulder shoulder{0, begin[0], {0, -1}};
  std::ptrdiff_t above = 0;
  for (std::ptrdiff_t k = 1; k <= size / 4; ++k) {
    if (begin[k - 1].y >= height || begin[k].y < height) continue;
    const float part = (height - begin[k - 1].y) / (begin[k].y - begin[k - 1].y);
    shoulder.rest = k;
    shoulder.at = {begin[k - 1].x + part * (begin[k].x - begin[k - 1].x), height};
    above = k;
    break;
  }
  // The direction over a tenth of the outline, which averages wobbles.
  const Point from = begin[std::min(size - 1, above + std::max<std::ptrdiff_t>(1, size / 10))];
  const Point down{shoulder.at.x - from.x, shoulder.at.y - from.y};
  const float length = std::hypot(down.x, down.y);
  if (length > 0) shoulder.way = {down.x / length, down.y / length};
  return shoulder;
}

void append_curve(std::vector<Point>& points, Point p, Point q, Point r, Point s) {
  constexpr int kSteps = 14;
  for (int k = 1; k <= kSteps; ++k) {
    const float u = static_cast<float>(k) / kSteps;
    const float v = 1 - u;
    const float a = v * v * v, b = 3 * v * v * u, c = 3 * v * u * u, d = u * u * u;
    points.push_back({a * p.x + b * q.x + c * r.x + d * s.x, a * p.y + b * q.y + c * r.y + d * s.y});
  }
}

// Closes the outline around the wick. What a camera sees of a base is chance: the threshold cuts it off straight, or
// runs back up along the wick between two corners. So below the shoulders the flame is drawn as a drop whose lowest
// point is `cap` units under the base's middle.
void close_base(std::vector<Point>& points, float cap) {
  float top = 0;
  for (const Point p : points) top = std::max(top, p.y);
  const float height = 0.17F * std::min(1.0F, top / 0.8F);
  const auto size = static_cast<std::ptrdiff_t>(points.size());
  const Shoulder left = shoulder_of(points.begin(), size, height);
  const Shoulder right = shoulder_of(points.rbegin(), size, height);
  points.erase(points.end() - right.rest, points.end());
  points.erase(points.begin(), points.begin() + left.rest);
  points.push_back(right.at);

  const Point lowest{0, -cap};
  const auto handle = [&](const Shoulder& side, float outwards) {
    const float reach = 0.5F * std::max(0.0F, side.at.y - lowest.y);
    // Sides that flare much would hang over the wick, and none may turn back up.
    const float across = outwards * std::min(0.6F, outwards * side.way.x);
    return Point{side.at.x + reach * across, side.at.y - reach * std::max(0.5F, -side.way.y)};
  };
  const float round = 0.28F * std::abs(right.at.x - left.at.x);
  append_curve(points, right.at, handle(right, 1), {lowest.x + round, lowest.y}, lowest);
  append_curve(points, lowest, {lowest.x - round, lowest.y}, handle(left, -1), left.at);
}

// Share of each cell inside the polygon; the grid's origin is (left, top), a cell is `cell` pixels.
Plane rasterised(std::span<const Point> pixels, float left, float top, float cell, int columns, int rows) {
  const CairoSurface surface(cairo_image_surface_create(CAIRO_FORMAT_A8, columns, rows));
  {
    const CairoContext context(cairo_create(surface.get()));
    cairo_set_antialias(context.get(), CAIRO_ANTIALIAS_BEST);
    for (const Point p : pixels) cairo_line_to(context.get(), (p.x - left) / cell, (p.y - top) / cell);
    cairo_close_path(context.get());
    cairo_fill(context.get());
  }
  cairo_surface_flush(surface.get());
  const unsigned char* data = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  Plane plane(columns, rows);
  for (int y = 0; y < rows; ++y) {
    const unsigned char* from = data + static_cast<std::ptrdiff_t>(y) * stride;
    for (int x = 0; x < columns; ++x) plane.row(y)[x] = static_cast<float>(from[x]) / 255;
  }
  return plane;
}

// Solves ∇²φ = −1 with φ = 0 outside by red-black successive over-relaxation (Press et al., Numerical Recipes, section
// 20.5), in squared cells. A cell that is covered in part holds its share, so that φ moves with the edge and does not
// jump from cell to cell. The number of sweeps is fixed: enough for a body 40 cells wide.
Plane solve_thickness(const Plane& inside) {
  constexpr float kRelaxation = 1.78F;
  constexpr int kSweeps = 44;
  const int width = inside.width + 2;
  Plane phi(width, inside.height + 2);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int colour = 0; colour < 2; ++colour) {
      for (int y = 1; y <= inside.height; ++y) {
        float* here = phi.row(y);
        const float* above = phi.row(y - 1);
        const float* below = phi.row(y + 1);
        const float* share = inside.row(y - 1) - 1;
        for (int x = 1 + (y + colour) % 2; x <= inside.width; x += 2) {
          if (share[x] == 0) continue;
          const float solved = share[x] * 0.25F * (here[x - 1] + here[x + 1] + above[x] + below[x] + 1);
          here[x] = std::max(0.0F, here[x] + kRelaxation * (solved - here[x]));
        }
      }
    }
  }
  return phi;
}

// Bilinear value of a grid with a border of one cell, at cell coordinates (cell centres at halves).
float sampled(const Plane& bordered, float x, float y) {
  const float u = std::clamp(x + 0.5F, 0.0F, static_cast<float>(bordered.width) - 1.001F);
  const float v = std::clamp(y + 0.5F, 0.0F, static_cast<float>(bordered.height) - 1.001F);
  const int i = static_cast<int>(u);
  const int j = static_cast<int>(v);
  const float a = u - static_cast<float>(i);
  const float b = v - static_cast<float>(j);
  const float* top = bordered.row(j) + i;
  const float* bottom = bordered.row(j + 1) + i;
  return (1 - b) * ((1 - a) * top[0] + a * top[1]) + b * ((1 - a) * bottom[0] + a * bottom[1]);
}

PixelBox visible_box(const Bounds& bounds, int width, int height) {
  const int left = std::max(0, static_cast<int>(std::floor(bounds.left)) - 1);
  const int top = std::max(0, static_cast<int>(std::floor(bounds.top)) - 1);
  const int right = std::min(width, static_cast<int>(std::ceil(bounds.right)) + 1);
  const int bottom = std::min(height, static_cast<int>(std::ceil(bounds.bottom)) + 1);
  if (left >= right || top >= bottom) return {};
  return {left, top, right - left, bottom - top};
}

Point to_pixel(const FlameScene& scene, Point p) {
  return {scene.base.x + scene.pixels_per_unit * p.x, scene.base.y - scene.pixels_per_unit * p.y};
}

void measure(FlameShape& shape, std::span<const Point> model) {
  const Point left = model.front();
  const Point right = model.back();
  shape.base = {(left.x + right.x) / 2, (left.y + right.y) / 2};
  shape.area = area_of(model);
  for (const Point p : model) {
    shape.height = std::max(shape.height, std::hypot(p.x - shape.base.x, p.y - shape.base.y));
    shape.middle.x += p.x / static_cast<float>(model.size());
    shape.middle.y += p.y / static_cast<float>(model.size());
  }
}

void fill_thickness(FlameShape& shape, std::span<const Point> pixels, const Bounds& bounds, float unit) {
  const float finest = std::max(1.0F, unit / kCellsPerUnit);
  const float cell = std::max({finest, bounds.width() / kMaxCells, bounds.height() / kMaxCells});
  const int columns = static_cast<int>(std::ceil(bounds.width() / cell)) + 2;
  const int rows = static_cast<int>(std::ceil(bounds.height() / cell)) + 2;
  const float left = bounds.left - cell;
  const float top = bounds.top - cell;
  const Plane phi = solve_thickness(rasterised(pixels, left, top, cell, columns, rows));

  shape.thickness = Plane(shape.box.width, shape.box.height);
  const float units = cell / unit;
  for (const float value : phi.values) shape.thickest = std::max(shape.thickest, value);
  shape.thickest = units * std::sqrt(2 * shape.thickest);
  for (int y = 0; y < shape.box.height; ++y) {
    const float v = (static_cast<float>(shape.box.y + y) + 0.5F - top) / cell;
    for (int x = 0; x < shape.box.width; ++x) {
      if (shape.coverage.row(y)[x] == 0) continue;
      const float u = (static_cast<float>(shape.box.x + x) + 0.5F - left) / cell;
      shape.thickness.row(y)[x] = units * std::sqrt(2 * sampled(phi, u, v));
    }
  }
}

}  // namespace

FlameShape measured_shape(std::span<const Point> outline, const FlameScene& scene, float scale) {
  FlameShape shape;
  std::vector<Point> points = finite_points(outline);
  if (points.size() < 3) return shape;
  for (Point& p : points) p = {scale * p.x, scale * p.y};
  measure(shape, points);
  shape.reach = scene.pixels_per_unit * shape.height;
  shape.base = to_pixel(scene, shape.base);
  shape.middle = to_pixel(scene, shape.middle);
  return shape;
}

FlameShape flame_shape(std::span<const Point> outline, const FlameScene& scene, float scale, float cap, int width,
                       int height) {
  FlameShape shape = measured_shape(outline, scene, scale);
  constexpr float kMinArea = 1e-5F;
  if (shape.area < kMinArea) return shape;

  std::vector<Point> points = finite_points(outline);
  for (Point& p : points) p = {scale * p.x, scale * p.y};
  close_base(points, cap);
  std::ranges::transform(points, points.begin(), [&](Point p) { return to_pixel(scene, p); });
  const float unit = scene.pixels_per_unit;
  const Bounds bounds = bounds_of(points);
  shape.box = visible_box(bounds, width, height);
  if (shape.empty()) return shape;
  shape.coverage = rasterised(points, static_cast<float>(shape.box.x), static_cast<float>(shape.box.y), 1,
                              shape.box.width, shape.box.height);
  fill_thickness(shape, points, bounds, unit);
  return shape;
}

namespace {

constexpr float kTau = 2 * std::numbers::pi_v<float>;

// Age of the oldest visible smoke, and duration of smoking, in seconds.
constexpr float kOldest = 4.0F;
constexpr float kSmoulders = 4.5F;

// The ribbon is drawn as parallel threads, which overlap where it folds.
constexpr int kThreads = 9;
constexpr float kThreadSeconds = 1.0F / 200;

// One oscillation of the ribbon: the sideways displacement varies with the time at which smoke left the wick.
struct Swing {
  float rate_hz;
  float across;  // model units, when fully grown
  float upward;
  float phase;
  float twist;  // how much it differs over the ribbon's width, in turns
};

std::array<Swing, 4> swings_of(std::uint64_t seed) {
  const auto phase = [&](int k) { return random_at(seed, 16 + k); };
  // Upward amplitudes are small enough that smoke never overtakes the smoke above it.
  return {{{0.50F, 0.135F, 0.012F, phase(0), 0.10F},
           {1.05F, 0.052F, 0.014F, phase(1), 0.20F},
           {1.90F, 0.017F, 0.007F, phase(2), -0.26F},
           {3.60F, 0.004F, 0.002F, phase(3), 0.4F}}};
}

// Position of smoke of an age that left the wick `left` seconds after extinction: model units from the wick's end.
Point drift(float left, float age, float side, float wind, std::span<const Swing> swings) {
  // Hot smoke starts fast and is slowed by entrained air.
  const float rise = 0.75F * age + 0.30F * (1 - std::exp(-age / 0.35F));
  constexpr float kTakesUpWind = 0.35F;
  const float carried = wind * (age - kTakesUpWind * (1 - std::exp(-age / kTakesUpWind)));
  const float grown = smooth_step(0.12F, 1.7F, age);
  Point p{carried + side * (0.008F + 0.060F * grown), rise};
  for (const Swing& swing : swings) {
    const float turn = kTau * (swing.rate_hz * left + swing.phase + swing.twist * side * grown - 0.12F * age);
    p.x += grown * swing.across * std::sin(turn);
    p.y += grown * swing.upward * std::cos(turn);
  }
  return p;
}

// Density over the picture, on a grid of cells, and the part of the grid where there is any.
struct Plume {
  Plane density;
  int left = 0, top = 0, right = -1, bottom = -1;
};

// A soft round dab of smoke.
void dab(Plume& plume, float x, float y, float radius, float amount) {
  Plane& density = plume.density;
  const int left = std::max(0, static_cast<int>(std::ceil(x - radius - 0.5F)));
  const int right = std::min(density.width - 1, static_cast<int>(std::floor(x + radius - 0.5F)));
  const int top = std::max(0, static_cast<int>(std::ceil(y - radius - 0.5F)));
  const int bottom = std::min(density.height - 1, static_cast<int>(std::floor(y + radius - 0.5F)));
  if (left > right || top > bottom) return;
  const bool first = plume.right < 0;
  plume.left = first ? left : std::min(plume.left, left);
  plume.top = first ? top : std::min(plume.top, top);
  plume.right = std::max(plume.right, right);
  plume.bottom = std::max(plume.bottom, bottom);
  const float per_square = 1 / (radius * radius);
  const float peak = amount * per_square;
  for (int row = top; row <= bottom; ++row) {
    const float dy = static_cast<float>(row) + 0.5F - y;
    float* out = density.row(row);
    for (int column = left; column <= right; ++column) {
      const float dx = static_cast<float>(column) + 0.5F - x;
      const float inside = std::max(0.0F, 1 - (dx * dx + dy * dy) * per_square);
      out[column] += peak * inside * inside;
    }
  }
}

// Density of all smoke in the air on a grid of `cell` pixels, of a wick that smoked for `smoking` seconds.
Plume risen(const Image& image, const FlameScene& scene, Point wick_end, float cell, float smoking) {
  Plume plume;
  plume.density = Plane(static_cast<int>(std::ceil(static_cast<float>(image.width()) / cell)) + 1,
                        static_cast<int>(std::ceil(static_cast<float>(image.height()) / cell)) + 1);
  const auto swings = swings_of(scene.seed);
  const float unit = scene.pixels_per_unit / cell;
  const float now = scene.seconds_since_out;
  const auto first = static_cast<long>(std::ceil(std::max(0.0F, now - kOldest) / kThreadSeconds));
  const auto last = static_cast<long>(std::floor(smoking / kThreadSeconds));
  for (long k = first; k <= last; ++k) {
    const float left = static_cast<float>(k) * kThreadSeconds;
    const float age = now - left;
    const float begun = smooth_step(0.0F, 0.40F, left);
    const float ended = burns(scene) ? smooth_step(0.0F, 0.25F, smoking - left) : 1;
    const float strength = begun * ended * std::exp(-left / 1.8F) * std::exp(-age / 1.5F) *
                           (1 - smooth_step(0.7F * kOldest, kOldest, age));
    const float radius = std::max(1.2F, unit * (0.011F + 0.022F * age));
    for (int thread = 0; thread < kThreads; ++thread) {
      const float side = 2.0F * static_cast<float>(thread) / (kThreads - 1) - 1;
      const Point p = drift(left, age, side, scene.wind, swings);
      dab(plume, wick_end.x / cell + unit * p.x, wick_end.y / cell - unit * p.y, radius,
          0.000115F * strength * unit * unit);
    }
  }
  return plume;
}

Light smoke_light(const FlameScene& scene, Point wick_end, std::span<const Lamp> lamps) {
  Light light{0.125F, 0.140F, 0.172F};
  for (const Lamp& lamp : lamps) {
    const float dx = (lamp.place.x - wick_end.x) / scene.pixels_per_unit;
    const float dy = (lamp.place.y - wick_end.y) / scene.pixels_per_unit + 0.6F;
    light = light + (0.10F * lamp.power / (0.4F + dx * dx + dy * dy)) * Light{1.0F, 0.66F, 0.36F};
  }
  return light;
}

}  // namespace

void draw_smoke(Image& image, const FlameScene& scene, Point wick_end, std::span<const Lamp> lamps) {
  const float out = scene.seconds_since_out;
  if (!std::isfinite(out)) return;
  const float smoking = std::min(kSmoulders, burns(scene) ? out - scene.seconds_since_lit : out);
  if (smoking <= 0 || out - smoking > kOldest) return;
  const float cell = std::max(1.0F, scene.pixels_per_unit / 110);
  const Plume plume = risen(image, scene, wick_end, cell, smoking);
  if (plume.right < 0) return;
  const Plane& density = plume.density;
  const Light light = smoke_light(scene, wick_end, lamps);
  // Interpolation reaches one cell beyond the smoke.
  const auto pixel = [&](int cells) { return static_cast<int>(static_cast<float>(cells) * cell); };
  const int end_y = std::min(image.height(), pixel(plume.bottom + 2));
  const int end_x = std::min(image.width(), pixel(plume.right + 2));
  for (int y = std::max(0, pixel(plume.top - 1)); y < end_y; ++y) {
    const float v = (static_cast<float>(y) + 0.5F) / cell - 0.5F;
    const int j = std::clamp(static_cast<int>(std::floor(v)), 0, density.height - 2);
    const float b = std::clamp(v - static_cast<float>(j), 0.0F, 1.0F);
    for (int x = std::max(0, pixel(plume.left - 1)); x < end_x; ++x) {
      const float u = (static_cast<float>(x) + 0.5F) / cell - 0.5F;
      const int i = std::clamp(static_cast<int>(std::floor(u)), 0, density.width - 2);
      const float a = std::clamp(u - static_cast<float>(i), 0.0F, 1.0F);
      const float* above = density.row(j) + i;
      const float* below = density.row(j + 1) + i;
      const float here = (1 - b) * ((1 - a) * above[0] + a * above[1]) + b * ((1 - a) * below[0] + a * below[1]);
      if (here < 1e-4F) continue;
      blend(image.row(y)[x], light, 1 - std::exp(-here), dither_at(x, y));
    }
  }
}

}  // namespace wisp::drawing
