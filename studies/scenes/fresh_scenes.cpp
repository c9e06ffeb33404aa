#include <algorithm>
#include <cmath>
#include <random>

#include "studies/scenes/scene_sets.hpp"

namespace wisp::scenes {
namespace {

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  double between(double low, double high) { return low + (high - low) * static_cast<double>(random_()) / 4294967296.0; }
  bool one_in(int n) { return random_() % static_cast<unsigned>(n) == 0; }
  int of(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

 private:
  std::mt19937 random_;
};

// A flame that a person would film so, on a candle, before whatever is there.
Scene fair_scene(Dice& dice) {
  Scene s;
  s.phase = dice.between(10, 1000);
  s.width = 200 + dice.of(8) * 40;
  s.height = 180 + dice.of(6) * 40;
  s.frames = 60;
  s.rate_hz = std::vector<double>{15, 24, 25, 30, 50, 60}[static_cast<std::size_t>(dice.of(6))];
  s.slenderness = dice.between(0.11, 0.21);
  s.bluntness = dice.between(1.3, 2.6);
  s.colour = {1, dice.between(0.7, 0.9), dice.between(0.3, 0.6)};
  s.liveliness = dice.between(0.3, 1.6);
  s.brightness = dice.between(2, 7);
  s.flame_height = dice.between(0.2, 0.42) * s.height;
  s.base_x = dice.between(0.4, 0.6);
  s.base_y = dice.between(0.6, 0.72);
  s.room = dice.between(0.001, 0.02);
  s.noise = dice.between(0.5, 5);
  s.exposure = std::exp(dice.between(-0.7, 0.7));
  if (!dice.one_in(4)) s.wax = {dice.between(0.05, 0.95), dice.between(0.05, 0.9), dice.between(0.03, 0.8)};
  s.halo = dice.one_in(3) ? dice.between(0, 0.015) : 0;
  s.wall = dice.one_in(3) ? dice.between(0.02, 0.15) : 0;
  s.rim = dice.one_in(3) ? dice.between(1, 4) : 1;
  s.glass = dice.one_in(5);
  s.glass_aside = dice.one_in(2) ? dice.between(0.45, 0.8) : dice.between(-0.8, -0.45);
  s.table = dice.one_in(6);
  if (s.table) s.base_y = 0.52;
  s.pool = s.wax.r > 0.5 && dice.one_in(5);
  s.auto_exposure = dice.one_in(5);
  s.blocks = dice.one_in(5);
  s.turn = dice.one_in(4) ? dice.between(-12, 12) : 0;
  s.shake = dice.one_in(5) ? dice.between(1, 5) : 0;
  s.still_light = dice.one_in(6) ? dice.between(0.2, 3) : 0;
  if (dice.one_in(5)) {
    s.candles = 2 + dice.of(2);
    s.width = std::max(s.width, static_cast<int>(4 * s.flame_height));
    s.still_light = 0;
  }
  return s;
}

// The same with what makes it unusable, or hard to see.
Named unfair_scene(Dice& dice, int kind) {
  Scene s = fair_scene(dice);
  s.fair = false;
  s.candles = 1;
  switch (kind) {
    case 0:
      s.base_x = dice.one_in(2) ? dice.between(0, 0.04) : dice.between(0.96, 1);
      s.turn = s.shake = 0;
      return {"at a side", s};
    case 1:
      s.base_y = 0.95 * s.flame_height / s.height;
      s.turn = s.shake = 0;
      return {"at the upper border", s};
    case 2:
      s.hand = true;
      return {"a hand in front", s};
    case 3:
      s.irregular = true;
      return {"lost frames", s};
    case 4:
      s.lamp = true;
      return {"a lamp", s};
    case 5:
      s.lamp = true;
      s.shake = dice.between(2, 6);
      return {"a lamp, shaken", s};
    case 6:
      s.flame_height = dice.between(4, 8);
      return {"too small", s};
    default:
      s.window = dice.between(0.8, 2);
      s.room = 0.2;
      s.exposure = dice.between(3, 6);
      return {"daylight, overexposed", s};
  }
}

std::string what_is_hard(const Scene& s) {
  std::string out;
  const auto say = [&](bool there, const char* what) {
    if (there) out += std::string(out.empty() ? "" : ", ") + what;
  };
  say(s.candles > 1, "candles");
  say(s.pool, "pool");
  say(s.glass, "glass");
  say(s.table, "table");
  say(s.wall > 0, "wall");
  say(s.still_light > 0, "lamp beside");
  say(s.rim > 1, "soft");
  say(s.shake > 0, "shaken");
  say(s.auto_exposure, "auto");
  say(s.blocks, "blocks");
  say(s.lit_from > 0, "lit");
  say(s.out_from > 0, "out");
  return out.empty() ? "plain" : out;
}

}  // namespace

std::vector<Named> fresh_scenes(unsigned seed) {
  constexpr int kFair = 80, kKinds = 8, kOfAKind = 3;
  Dice dice(seed);
  std::vector<Named> out;
  for (int k = 0; k < kFair; ++k) {
    Scene s = fair_scene(dice);
    if (k % 8 == 0) s.out_from = 40;
    if (k % 8 == 4) s.frames = 140, s.lit_from = 60;
    out.push_back({std::to_string(k) + " " + what_is_hard(s), s});
  }
  for (int k = 0; k < kKinds * kOfAKind; ++k) {
    const Named unfair = unfair_scene(dice, k / kOfAKind);
    out.push_back(
        {"unfair " + std::to_string(k) + ": " + unfair.name + ", " + what_is_hard(unfair.scene), unfair.scene});
  }
  return out;
}

}  // namespace wisp::scenes
