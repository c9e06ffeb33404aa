// The flame's outline is a drop on a wick whose height, width and lean follow a few incommensurate waves, as the rig's
// do. Light is added up linearly, then exposed, clipped and given a display's gamma, as a camera does.

#include "studies/scenes/scene.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace wisp::scenes {
namespace {

constexpr double kGamma = 1 / 2.2;
constexpr double kMidGrey = 0.22;  // light that is displayed as half as bright as white: where a flame is seen to end

Light operator+(const Light& a, const Light& b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
Light operator*(const Light& a, double s) { return {a.r * s, a.g * s, a.b * s}; }
Light mix(const Light& under, const Light& over, double cover) { return under * (1 - cover) + over * cover; }

// One flame at one time.
struct Drop {
  double x = 0;  // its foot
  double y = 0;
  double height = 1;
  double half_width = 1;
  double lean = 0;  // of the tip, pixels to the right
  double bluntness = 1.8;
  double rim = 1;

  // How deep a point lies inside, pixels; exact enough near the rim for an edge of a pixel.
  double depth(double px, double py) const {
    const double up = (y - py) / height;
    if (up < 0 || up > 1) {
      const double end = std::clamp(up, 0.0, 1.0);
      const double aside = std::max(0.0, std::abs(px - x - lean * end * end) - width_at(end));
      return -std::hypot(aside, std::max(py - y, y - height - py) + 0.5);
    }
    const double middle = x + lean * up * up;
    const double side = width_at(up) - std::abs(px - middle);
    const double slope = (width_at(std::min(up + 0.01, 1.0)) - width_at(std::max(up - 0.01, 0.0))) / (0.02 * height);
    return std::min(side / std::sqrt(1 + slope * slope), y - py + 0.5);
  }
  // Widest a third up, two thirds as wide at its foot, pointed at its tip.
  double width_at(double up) const {
    if (up < 0.33) return half_width * (1 - 0.33 * std::pow(1 - up / 0.33, 2));
    const double rest = (up - 0.33) / 0.67;
    return half_width * (1 - std::pow(rest, bluntness));
  }
};

double wave(double t, double seed) {
  return 0.5 * std::sin(2.3 * t + seed) + 0.3 * std::sin(5.9 * t + 2.1 * seed) + 0.2 * std::sin(11.7 * t + 0.7 * seed);
}

Drop drop_at(const Scene& scene, int which, int k) {
  const double t = k / scene.rate_hz, seed = scene.phase + 1.7 * which, lively = scene.lamp ? 0 : scene.liveliness;
  const double size = scene.flame_height * (which == 0 ? 1 : 0.8 - 0.1 * which);
  Drop drop;
  const double spacing = 0.3 * scene.width;
  drop.x = scene.base_x * scene.width + (which == 0 ? 0 : which == 1 ? spacing : -spacing);
  drop.y = scene.base_y * scene.height + (which == 0 ? 0 : 0.12 * scene.flame_height);
  drop.height = size * (1 + 0.18 * lively * wave(t, seed));
  drop.half_width = scene.slenderness * size * (1 + 0.1 * lively * wave(1.3 * t, seed + 1));
  drop.lean = 0.25 * size * lively * wave(0.8 * t, seed + 2);
  drop.bluntness = scene.bluntness;
  drop.rim = scene.rim;
  return drop;
}

double cover(const Drop& drop, double x, double y) { return std::clamp(0.5 + drop.depth(x, y) / drop.rim, 0.0, 1.0); }

// What stands below a flame: a cylinder of wax, lit from above, with or without a pool as bright as the flame.
Light candle(const Scene& scene, const Drop& drop, double x, double y, Light under, double burning) {
  const double half = 0.45 * scene.flame_height, top = drop.y + (scene.pool ? 0 : 0.08) * scene.flame_height;
  const double wick = 0.02 * scene.flame_height + 0.5;
  if (!scene.pool && std::abs(x - drop.x) < wick && y > drop.y && y <= top + 1) return {0.01, 0.008, 0.006};
  const Light& wax = scene.wax;
  if (wax.r + wax.g + wax.b == 0) return under;
  if (scene.pool) {
    const double across = (x - drop.x) / (1.6 * half), down = (y - drop.y - 0.2 * half) / (0.25 * half);
    if (across * across + down * down < 1) return wax * (1.1 * burning + scene.room);
  }
  if (std::abs(x - drop.x) > half || y < top) return under;
  const double deep = (y - top) / scene.flame_height;
  return wax * (0.9 * burning * std::exp(-0.9 * deep) + scene.room + scene.window * 0.3);
}

Light behind(const Scene& scene, const Drop& drop, double x, double y, double burning) {
  Light light = Light{1, 1, 1} * scene.room;
  const double far = std::hypot(x - drop.x, y - drop.y + 0.5 * drop.height) / scene.flame_height;
  light = light + scene.colour * (burning * scene.wall / (1 + far * far));
  const double halo = scene.halo * scene.brightness * std::exp(-3 * std::max(0.0, far - 0.3));
  light = light + scene.colour * (burning * halo);
  const bool window = x < 0.3 * scene.width && y < 0.6 * scene.height && x > 0.05 * scene.width;
  const double lamp = std::hypot(x - 0.82 * scene.width, y - 0.25 * scene.height) / (0.07 * scene.width);
  if (lamp < 1) light = light + Light{1, 0.9, 0.7} * scene.still_light;
  if (scene.window > 0) light = light + Light{0.9, 0.95, 1} * (window ? scene.window : 0.15 * scene.window);
  return light;
}

// The picture's light at one place.
Light light_at(const Scene& scene, const std::vector<Drop>& drops, double x, double y, double burning) {
  Light light = behind(scene, drops.front(), x, y, burning);
  const Drop& first = drops.front();
  if (scene.glass) {
    Drop image = first;
    image.x += scene.glass_aside * scene.flame_height;
    image.y -= 0.9 * scene.flame_height;
    image.height *= 0.5;
    image.half_width *= 0.5;
    image.lean *= -0.5;
    light = light + scene.colour * (0.35 * burning * cover(image, x, y));
  }
  const double table = first.y + 0.5 * scene.flame_height;
  if (scene.table && y > table) {
    const double mirrored = 2 * table - y;
    Light image{};
    for (const Drop& drop : drops) image = image + scene.colour * (0.3 * burning * cover(drop, x, mirrored));
    return Light{0.05, 0.03, 0.02} * (burning * 0.4 + scene.room) + image;
  }
  for (const Drop& drop : drops) light = candle(scene, drop, x, y, light, burning);
  for (const Drop& drop : drops) {
    const double up = std::clamp((drop.y - y) / drop.height, 0.0, 1.0);
    // The foot is dim and bluish, as around a wick, where no pool outshines it.
    const double bright = scene.pool ? 1 : std::clamp(up / 0.08, 0.0, 1.0);
    const Light core = mix(Light{0.12, 0.16, 0.35}, scene.colour * scene.brightness, bright);
    light = mix(light, core, burning * cover(drop, x, y));
  }
  return light;
}

// Display levels of linear light from 0 to 1, finely.
std::vector<double> gamma_table() {
  std::vector<double> table(4097);
  for (std::size_t k = 0; k < table.size(); ++k) table[k] = 255 * std::pow(static_cast<double>(k) / 4096, kGamma);
  return table;
}

std::vector<double> noise_table() {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0, 1);
  std::vector<double> table(4096);
  for (double& value : table) value = normal(random);
  return table;
}

std::uint8_t stored(double light, double noise) {
  static const std::vector<double> gamma = gamma_table();
  const double value = gamma[static_cast<std::size_t>(4096 * std::clamp(light, 0.0, 1.0))] + noise;
  return static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0));
}

// Averages over 8 × 8 blocks and quantises what is left coarsely.
void make_blocks(const Scene& scene, std::vector<std::uint8_t>& rgb) {
  constexpr int kBlock = 8;
  constexpr double kStep = 12;
  for (int y0 = 0; y0 < scene.height; y0 += kBlock) {
    for (int x0 = 0; x0 < scene.width; x0 += kBlock) {
      for (int c = 0; c < 3; ++c) {
        double sum = 0;
        int count = 0;
        const auto each = [&](const auto& apply) {
          for (int y = y0; y < std::min(y0 + kBlock, scene.height); ++y) {
            for (int x = x0; x < std::min(x0 + kBlock, scene.width); ++x) {
              apply(rgb[(static_cast<std::size_t>(y) * scene.width + x) * 3 + c]);
            }
          }
        };
        each([&](const std::uint8_t& value) { sum += value, ++count; });
        const double mean = sum / count;
        each([&](std::uint8_t& value) {
          value = static_cast<std::uint8_t>(std::clamp(mean + kStep * std::round((value - mean) / kStep), 0.0, 255.0));
        });
      }
    }
  }
}

}  // namespace

SceneFrame film(const Scene& scene, int k) {
  SceneFrame frame;
  std::mt19937 random(static_cast<unsigned>(1000 + k + 7919 * std::lround(10 * scene.phase)));
  static const std::vector<double> noise = noise_table();
  frame.lost = scene.irregular && k > 0 && random() % 3 == 0;
  frame.burning = k >= scene.lit_from && (scene.out_from == 0 || k < scene.out_from);
  std::vector<Drop> drops;
  for (int which = 0; which < scene.candles; ++which) drops.push_back(drop_at(scene, which, k));
  const double burning = frame.burning ? 1 : 0;
  const double flicker = drops.front().height / scene.flame_height;
  const double exposure = scene.exposure * (scene.auto_exposure ? 1 / (0.4 + 0.6 * flicker * flicker) : 1);
  const double t = k / scene.rate_hz;
  const double sx = scene.shake * wave(1.1 * t, 5), sy = scene.shake * wave(1.4 * t, 9);
  const double c = std::cos(scene.turn / 57.3), s = std::sin(scene.turn / 57.3);
  frame.rgb.resize(static_cast<std::size_t>(scene.width) * scene.height * 3);
  frame.flame = {scene.width, scene.height,
                 std::vector<std::uint8_t>(static_cast<std::size_t>(scene.width) * scene.height)};
  const double cx = 0.5 * scene.width, cy = 0.5 * scene.height;
  const double hand = scene.hand ? scene.width * (1.5 - 3.0 * k / scene.frames) : -1e9;
  for (int y = 0; y < scene.height; ++y) {
    for (int x = 0; x < scene.width; ++x) {
      const double px = cx + c * (x - cx) + s * (y - cy) + sx, py = cy - s * (x - cx) + c * (y - cy) + sy;
      Light light = light_at(scene, drops, px, py, burning);
      const bool hidden = std::abs(px - hand) < 0.08 * scene.width && py > 0.1 * scene.height;
      if (hidden) light = Light{0.12, 0.07, 0.05};
      const std::size_t at = static_cast<std::size_t>(y) * scene.width + x;
      const auto dice = static_cast<std::uint32_t>(random());
      frame.rgb[3 * at] = stored(light.r * exposure, scene.noise * noise[dice & 4095]);
      frame.rgb[3 * at + 1] = stored(light.g * exposure, scene.noise * noise[(dice >> 10) & 4095]);
      frame.rgb[3 * at + 2] = stored(light.b * exposure, scene.noise * noise[dice >> 20]);
      const double shine = cover(drops.front(), px, py) * scene.brightness * exposure;
      // The dim foot is no part of what a person would outline.
      const bool in = shine > kMidGrey && drops.front().y - py > 0.04 * drops.front().height;
      frame.flame.at(x, y) = in && !hidden && frame.burning;
    }
  }
  if (scene.blocks) make_blocks(scene, frame.rgb);
  return frame;
}

}  // namespace wisp::scenes
