// Pictures of outlines: flames, or filled shapes on a plain background; and outlines of bodies that are given as rings.

#include <algorithm>
#include <cmath>
#include <vector>

#include "draw/cairo.hpp"
#include "draw/flame/flame_layers.hpp"
#include "wisp/draw/flame.hpp"
#include "wisp/draw/overlay.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

using namespace drawing;

void show_state(const LitState& state, FlameScene& scene) {
  const auto seconds = [](std::chrono::nanoseconds age) {
    return age == kNever ? kLongAgo : std::chrono::duration<float>(age).count();
  };
  scene.seconds_since_lit = seconds(state.since_lit);
  scene.seconds_since_out = seconds(state.since_out);
  scene.size = state.size;
}

void SmokeDrift::blow(float wind, const LitState& state, std::chrono::nanoseconds step_time, FlameScene& scene) {
  // Flame heights a second that smoke drifts in a wind of 1; real smoke would leave the picture at once.
  constexpr float kSmokeCarried = 1.5F;
  if (state.since_out == kNever) return;
  if (state.went_out || state.since_out <= step_time) sum_ = count_ = 0;  // a call may make several steps
  sum_ += wind;
  count_ += 1;
  scene.wind = kSmokeCarried * sum_ / count_;
}

bool burns(const FlameScene& scene) { return scene.seconds_since_lit <= scene.seconds_since_out; }

void draw_flames(Image& image, std::span<const Flame> flames, const FlameStyle& asked) {
  if (image.empty() || flames.empty()) return;
  const FlameStyle style = clamped(asked);
  std::vector<Candle> candles;
  for (const Flame& flame : flames) candles.push_back(prepared(flame, image.width(), image.height()));
  draw_behind(image, candles, style);
  LightField field(image.width(), image.height());
  for (const Candle& candle : candles) add_own_light(field, candle, style);
  if (style.glow > 0) add_halo(field, glow_rings(style, largest_unit(candles)));
  add_light(image, field);
}

FlameScene framed(int width, int height) {
  FlameScene scene;
  scene.pixels_per_unit = std::min(static_cast<float>(height) * 0.31F, static_cast<float>(width) * 0.45F);
  scene.base = {static_cast<float>(width) / 2, static_cast<float>(height) * 0.63F};
  return scene;
}

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kHighest = 80;  // degrees

// A ring seen by the camera: centre, radius to the right, and how far the right and the near rim rise in the picture.
struct SeenRing {
  double x, y;
  double radius;
  double right_up, near_up;

  Point rim(double angle) const {
    return {static_cast<float>(x + radius * std::cos(angle)),
            static_cast<float>(y + right_up * std::cos(angle) + near_up * std::sin(angle))};
  }
};

SeenRing seen(const float* ring, const Camera& camera) {
  const double c = std::cos(camera.azimuth * kDegree), s = std::sin(camera.azimuth * kDegree);
  const double raised = std::clamp(camera.elevation, -kHighest, kHighest) * kDegree;
  const double up = std::cos(raised), down = std::sin(raised);
  const double near = s * ring[0] + c * ring[2];
  return {c * ring[0] - s * ring[2], up * ring[1] - down * near, ring[3], up * (c * ring[4] - s * ring[5]),
          up * (s * ring[4] + c * ring[5]) - down * ring[3]};
}

// Returns the cross product of the surface's tangents in the picture, whose sign changes at the silhouette.
double facing(const SeenRing& below, const SeenRing& ring, const SeenRing& above, double angle) {
  const Point from = below.rim(angle), to = above.rim(angle);
  const double around_x = -ring.radius * std::sin(angle);
  const double around_y = -ring.right_up * std::sin(angle) + ring.near_up * std::cos(angle);
  return (to.x - from.x) * around_y - (to.y - from.y) * around_x;
}

// Returns the angle of the silhouette nearest to the angle `side`; `side` itself if none is within 90 degrees.
double edge_of(const SeenRing& below, const SeenRing& ring, const SeenRing& above, double side) {
  constexpr int kSteps = 32;
  const double step = 90 * kDegree / kSteps;
  const double first = facing(below, ring, above, side);
  for (int k = 1; k <= kSteps && first != 0; ++k) {
    for (const double way : {-step, step}) {
      const double here = facing(below, ring, above, side + way * k);
      if ((here < 0) == (first < 0)) continue;
      const double before = facing(below, ring, above, side + way * (k - 1));
      return side + way * (k - 1 + before / (before - here));
    }
  }
  return side;
}

constexpr Colour kGround{38, 41, 46, 255};
constexpr Colour kShape{176, 184, 192, 255};
constexpr Colour kEdge{236, 240, 244, 255};
constexpr float kNarrower = 0.8F;  // maximum ratio of a flame's width at 0.88 of the tip's height to the width at 0.4

// Returns the control polygon at the centre of its range, in the model's units.
std::vector<Point> middle_polygon(const Model& model) {
  std::vector<Point> out;
  const auto middle = [](const Output& output) { return static_cast<float>(0.5 * (output.lowest + output.highest)); };
  for (std::size_t k = 0; k + 1 < model.outputs.size(); k += 2) {
    out.push_back({middle(model.outputs[k]), middle(model.outputs[k + 1])});
  }
  return out;
}

float width_at(const std::vector<Point>& outline, float height) {
  float low = 1e30F, high = -1e30F;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Point a = outline[k], b = outline[(k + 1) % outline.size()];
    if ((a.y > height) == (b.y > height)) continue;
    const float x = a.x + (height - a.y) / (b.y - a.y) * (b.x - a.x);
    low = std::min(low, x);
    high = std::max(high, x);
  }
  return std::max(0.0F, high - low);
}

void fill(Image& image, const std::vector<Point>& pixels) {
  const CairoContext context = context_of(image);
  cairo_move_to(context.get(), pixels.front().x, pixels.front().y);
  for (const Point p : pixels) cairo_line_to(context.get(), p.x, p.y);
  cairo_close_path(context.get());
  set_colour(context.get(), kShape);
  cairo_fill(context.get());
}

}  // namespace

bool is_flame(const Model& model) {
  if (!std::holds_alternative<OutlineView>(model.view) || model.outputs.empty()) return false;
  if (model.extinction) return true;
  const std::vector<Point> outline = middle_polygon(model);
  const auto farther = [](Point a, Point b) { return std::hypot(a.x, a.y) < std::hypot(b.x, b.y); };
  const Point tip = *std::max_element(outline.begin(), outline.end(), farther);
  const bool stands = tip.y > std::abs(tip.x) && outline.front().x < outline.back().x;
  return stands && width_at(outline, 0.88F * tip.y) < kNarrower * width_at(outline, 0.4F * tip.y);
}

FlameStyle candle_style(const Model& model) {
  FlameStyle style;
  const std::vector<Figure>& figures = model.training.figures;
  const auto found =
      std::find_if(figures.begin(), figures.end(), [](const Figure& one) { return one.name == kCandleFigures[0]; });
  if (figures.end() - found < std::ssize(kCandleFigures)) return style;
  style.candle_width = static_cast<float>(found->value);
  // Daylight: restores the green and blue that white wax lacks beside a flame. The largest channel is at most 240.
  constexpr std::array<double, 3> kLit{1.0, 0.86, 0.66};
  std::array<double, 3> wax{};
  for (std::size_t k = 0; k < 3; ++k) wax[k] = found[static_cast<std::ptrdiff_t>(k) + 1].value / kLit[k];
  const double most = std::max({wax[0], wax[1], wax[2], 1.0});
  const auto level = [&](double one) {
    return static_cast<std::uint8_t>(std::lround(240 * std::clamp(one / most, 0.0, 1.0)));
  };
  style.wax = {level(wax[0]), level(wax[1]), level(wax[2])};
  return style;
}

void draw_shapes(Image& image, std::span<const Flame> shapes) {
  {
    const CairoContext context = context_of(image);
    set_colour(context.get(), kGround);
    cairo_paint(context.get());
  }
  for (const Flame& shape : shapes) {
    std::vector<Point> pixels;
    for (const Point p : shape.outline) {
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) continue;
      pixels.push_back({shape.scene.base.x + p.x * shape.scene.pixels_per_unit,
                        shape.scene.base.y - p.y * shape.scene.pixels_per_unit});
    }
    if (pixels.size() < 3) continue;
    fill(image, pixels);
    draw_outline(image, pixels, {.colour = kEdge, .casing = 0});
  }
}

void see_body(std::span<const float> rings, const Camera& camera, std::span<Point> outline) {
  const std::size_t count = rings.size() / kRingNumbers;
  const auto at = [&](std::size_t k) { return seen(&rings[std::min(k, count - 1) * kRingNumbers], camera); };
  for (std::size_t k = 0; k < count; ++k) {
    const SeenRing below = at(k > 0 ? k - 1 : 0), ring = at(k), above = at(k + 1);
    const bool level = camera.elevation == 0;
    outline[k] = ring.rim(level ? 180 * kDegree : edge_of(below, ring, above, 180 * kDegree));
    outline[outline.size() - 1 - k] = ring.rim(level ? 0 : edge_of(below, ring, above, 0));
  }
}

float to_the_right(const Camera& camera, float x, float z) {
  return static_cast<float>(std::cos(camera.azimuth * kDegree) * x - std::sin(camera.azimuth * kDegree) * z);
}

}  // namespace wisp
