#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "draw/flame/flame_layers.hpp"

namespace wisp::drawing {
namespace {

constexpr float kTau = 2 * std::numbers::pi_v<float>;

// Age of the oldest visible smoke, and duration of smoking, in seconds.
constexpr float kOldest = 4.0F;
constexpr float kSmoulders = 4.5F;

// The ribbon is drawn as parallel threads, which overlap where it folds.
constexpr int kThreads = 9;
constexpr float kThreadSeconds = 1.0F / 200;

// One oscillation of the ribbon: the sideways displacement depends on the time at which the smoke left the wick.
struct Swing {
  float rate_hz;
  float across;  // model units, at full size
  float upward;
  float phase;
  float twist;  // phase difference over half the ribbon's width, in turns
};

std::array<Swing, 4> swings_of(std::uint64_t seed) {
  const auto phase = [&](int k) { return random_at(seed, 16 + k); };
  // Upward amplitudes are small enough that smoke never overtakes the smoke above it.
  return {{{0.50F, 0.135F, 0.012F, phase(0), 0.10F},
           {1.05F, 0.052F, 0.014F, phase(1), 0.20F},
           {1.90F, 0.017F, 0.007F, phase(2), -0.26F},
           {3.60F, 0.004F, 0.002F, phase(3), 0.4F}}};
}

// Returns the position, in model units from the wick's end, of smoke of age `age` that left `left` s after extinction.
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

// Smoke density on a grid of cells over the picture, and the bounds of its non-zero part.
struct Plume {
  Plane density;
  int left = 0, top = 0, right = -1, bottom = -1;
};

// Adds a soft round dab of smoke.
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

// Returns the density of all airborne smoke of a wick that smoked for `smoking` seconds, on a grid of `cell` pixels.
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
