#include <array>

#include "studies/scenes/scene_sets.hpp"

namespace wisp::scenes {
namespace {

constexpr std::array<Light, 5> kWaxes{Light{0.9, 0.85, 0.75}, Light{0.95, 0.6, 0.1}, Light{0.7, 0.05, 0.04},
                                      Light{0.1, 0.4, 0.12}, Light{0.35, 0.3, 0.6}};

}  // namespace

std::vector<Named> tuning_scenes() {
  std::vector<Named> out;
  const auto add = [&](std::string name, Scene scene) { out.push_back({std::move(name), scene}); };
  constexpr std::array<const char*, 5> kColour{"white", "yellow", "red", "green", "violet"};
  for (std::size_t w = 0; w < kWaxes.size(); ++w) {
    const std::string colour = kColour[w];
    const Scene lit{.wax = kWaxes[w], .halo = 0.01};
    add("wax " + colour, lit);
    for (const double exposure : {0.4, 2.5}) {
      Scene s = lit;
      s.exposure = exposure;
      add("wax " + colour + (exposure < 1 ? ", dark" : ", light"), s);
    }
    Scene s = lit;
    s.glass = true;
    add("glass, " + colour, s);
    s = lit;
    s.table = true;
    s.base_y = 0.5;
    add("table, " + colour, s);
    s = lit;
    s.wall = 0.15;
    add("wall, " + colour, s);
    s = lit;
    s.auto_exposure = true;
    add("auto-exposure, " + colour, s);
    s = lit;
    s.blocks = true;
    s.noise = 3;
    add("blocks and noise, " + colour, s);
    s = lit;
    s.candles = 2;
    s.width = 360;
    add("two candles, " + colour, s);
    s = lit;
    s.shake = 4;
    add("shaken, " + colour, s);
    s = lit;
    s.out_from = 42;
    add("blown out, " + colour, s);
    s = lit;
    s.pool = true;
    add("pool, " + colour, s);
  }
  const Scene plain{.wax = kWaxes[1]};
  for (const int height : {12, 24, 50}) {
    Scene s = plain;
    s.flame_height = height;
    add("small " + std::to_string(height) + " px", s);
  }
  for (const int height : {200, 400, 800}) {
    Scene s = plain;
    s.flame_height = height;
    s.width = static_cast<int>(1.2 * height);
    s.height = static_cast<int>(1.6 * height);
    s.frames = 40;
    s.base_y = 0.85;
    add("large " + std::to_string(height) + " px", s);
  }
  for (const double turn : {-15.0, -8.0, 8.0, 15.0}) {
    Scene s = plain;
    s.turn = turn;
    add("turned " + std::to_string(static_cast<int>(turn)) + " degrees", s);
  }
  for (const double rate : {12.0, 120.0, 240.0}) {
    Scene s = plain;
    s.rate_hz = rate;
    s.frames = rate > 100 ? 120 : 60;
    add("rate " + std::to_string(static_cast<int>(rate)), s);
  }
  for (const double noise : {4.0, 8.0}) {
    Scene s = plain;
    s.noise = noise;
    add("noise " + std::to_string(static_cast<int>(noise)), s);
  }
  for (const double calm : {0.15, 0.4, 1.8}) {
    Scene s = plain;
    s.liveliness = calm;
    add("liveliness " + std::to_string(calm).substr(0, 4), s);
  }
  Scene s = plain;
  s.candles = 3;
  s.width = 400;
  add("three candles", s);
  s = plain;
  s.wax = {};
  add("nothing but the flame", s);
  s.base_y = 1.02;
  add("nothing but the flame, cut off below", s);
  // What a person would not call filmable.
  s = plain;
  s.fair = false;
  s.base_x = 0.03;
  add("unfair: at the left border", s);
  s.base_x = 0.97;
  add("unfair: at the right border", s);
  s.base_x = 0.5;
  s.base_y = 0.34;
  add("unfair: at the upper border", s);
  s = plain;
  s.fair = false;
  s.hand = true;
  s.frames = 60;
  add("unfair: a hand in front", s);
  s = plain;
  s.fair = false;
  s.irregular = true;
  add("unfair: lost frames", s);
  s = plain;
  s.fair = false;
  s.lamp = true;
  add("unfair: a lamp", s);
  s.window = 1.5;
  add("unfair: a lamp and a window", s);
  s = plain;
  s.fair = false;
  s.flame_height = 6;
  add("unfair: 6 pixels", s);
  s = plain;
  s.window = 1.5;
  s.room = 0.2;
  s.fair = false;
  s.exposure = 4;
  add("unfair: daylight, overexposed", s);
  s.exposure = 0.6;
  s.fair = true;
  add("daylight, exposed for the flame", s);
  return out;
}

}  // namespace wisp::scenes
