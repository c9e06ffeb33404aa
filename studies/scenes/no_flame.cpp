// Every kind is a function from a place and a time to light; a camera's gamma and noise follow, as in scene.cpp. A
// codec's noise is added by tools/fit_verdict.py, which codes the films.

#include "studies/scenes/no_flame.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>

namespace wisp::scenes {
namespace {

struct Colour {
  double r = 0;
  double g = 0;
  double b = 0;
};

Colour operator*(const Colour& a, double s) { return {a.r * s, a.g * s, a.b * s}; }
Colour operator+(const Colour& a, const Colour& b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
Colour over(const Colour& under, const Colour& top, double cover) { return under * (1 - cover) + top * cover; }

constexpr double kTurn = 6.283185307179586;

// A number in [low, high) that belongs to a film, a thing and one of its properties.
struct Dice {
  unsigned seed = 0;
  double operator()(int thing, int property, double low = 0, double high = 1) const {
    std::seed_seq words{seed, static_cast<unsigned>(thing), static_cast<unsigned>(property)};
    std::mt19937 random(words);
    random.discard(3);
    return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
  }
};

double edge(double inside, double soft = 1) { return std::clamp(0.5 + inside / soft, 0.0, 1.0); }

double box(double x, double y, double left, double top, double width, double height, double soft = 1) {
  return edge(std::min({x - left, left + width - x, y - top, top + height - y}), soft);
}

double disc(double x, double y, double cx, double cy, double rx, double ry, double soft = 1) {
  const double reach = std::hypot((x - cx) / rx, (y - cy) / ry);
  return edge((1 - reach) * std::min(rx, ry), soft);
}

using Light = std::function<Colour(double x, double y)>;

// What is drawn: the film's numbers, its size and the time.
struct Stage {
  Dice dice;
  double w = 0;
  double h = 0;
  double t = 0;
};

Light street(const Stage& s) {
  struct Walker {
    double x, y, size;
    Colour colour;
  };
  std::vector<Walker> walkers;
  for (int k = 0; k < 6; ++k) {
    const double speed = s.dice(k, 0, -0.12, 0.12) * s.w, from = s.dice(k, 1) * s.w;
    const double x = std::fmod(from + speed * s.t + 10 * s.w, 1.2 * s.w) - 0.1 * s.w;
    const double grey = s.dice(k, 2, 0.02, 0.5);
    walkers.push_back({x, s.h * s.dice(k, 3, 0.5, 0.85), s.h * s.dice(k, 4, 0.05, 0.12),
                       Colour{grey, grey, grey} + Colour{s.dice(k, 5, 0, 0.3), 0, 0}});
  }
  const double pane_x = s.dice(90, 0, 0.1, 0.8) * s.w, pane_w = s.dice(90, 1, 0.04, 0.1) * s.w,
               pane_h = s.dice(90, 2, 0.08, 0.25) * s.h;
  const double pane = s.dice(90, 3, 0.5, 2) * (1 + 0.1 * std::sin(3 * s.t + s.dice(90, 4, 0, 6)));
  return [=](double x, double y) {
    Colour light = y < 0.4 * s.h ? Colour{0.2, 0.2, 0.22} : Colour{0.15, 0.15, 0.14};
    light = over(light, Colour{0.9, 0.95, 1} * pane, box(x, y, pane_x, 0.1 * s.h, pane_w, pane_h));
    for (const Walker& walker : walkers) {
      const double step = 0.15 * walker.size * std::sin(8 * s.t + walker.y);
      const double body = disc(x, y, walker.x, walker.y, 0.4 * walker.size, 1.4 * walker.size);
      const double head = disc(x, y, walker.x, walker.y - 1.8 * walker.size, 0.35 * walker.size, 0.4 * walker.size);
      const double leg =
          box(x, y, walker.x - 0.3 * walker.size + step, walker.y + walker.size, 0.5 * walker.size, 1.5 * walker.size);
      light = over(light, walker.colour, std::max({body, head, leg}));
    }
    return light;
  };
}

Light cartoon(const Stage& s) {
  struct Shape {
    double x, y, rx, ry;
    Colour colour;
  };
  std::vector<Shape> shapes;
  for (int k = 1; k < 6; ++k) {
    const double wave = std::sin(s.dice(k, 0, 1, 5) * s.t + s.dice(k, 1, 0, 6));
    const double x = s.w * (s.dice(k, 2) + 0.1 * wave),
                 y = s.h * (s.dice(k, 3) + 0.08 * std::cos(s.dice(k, 4, 1, 4) * s.t));
    const double rx = s.w * s.dice(k, 5, 0.04, 0.2), ry = s.h * s.dice(k, 6, 0.04, 0.25) * (1 + 0.15 * wave);
    shapes.push_back({x, y, rx, ry, Colour{s.dice(k, 7), s.dice(k, 8), s.dice(k, 9)} * 1.1});
  }
  const Colour ground{s.dice(0, 0, 0, 0.6), s.dice(0, 1, 0, 0.6), s.dice(0, 2, 0, 0.6)};
  return [=](double x, double y) {
    Colour light = ground;
    for (const Shape& one : shapes) light = over(light, one.colour, disc(x, y, one.x, one.y, one.rx, one.ry));
    return light;
  };
}

// Leaves before a sky: where none is, the sky is seen.
Light leaves(const Stage& s, double sky, double ground, int count) {
  struct Leaf {
    double x, y, r;
    Colour colour;
  };
  std::vector<Leaf> all;
  for (int k = 0; k < count; ++k) {
    const double sway = 0.015 * s.w * std::sin(s.dice(k, 0, 2, 5) * s.t + s.dice(k, 1, 0, 6));
    const double green = s.dice(k, 4, 0.02, 0.25);
    all.push_back({s.w * s.dice(k, 2) + sway,
                   s.h * s.dice(k, 3) + 0.4 * sway,
                   s.w * s.dice(k, 5, 0.02, 0.06),
                   {0.5 * green, green, 0.2 * green}});
  }
  return [=](double x, double y) {
    Colour light = y > 0.85 * s.h ? Colour{0.1, 0.12, 0.05} * ground : Colour{0.8, 0.9, 1} * sky;
    for (const Leaf& leaf : all)
      if (std::abs(x - leaf.x) < leaf.r + 1)
        light = over(light, leaf.colour, disc(x, y, leaf.x, leaf.y, leaf.r, 0.6 * leaf.r));
    return light;
  };
}

Light tree(const Stage& s) { return leaves(s, s.dice(99, 0, 0.3, 0.8), 1, 90); }
Light sky(const Stage& s) { return leaves(s, s.dice(99, 0, 0.9, 2.5), 0.2, 240); }

Light pane(const Stage& s) {
  const double x0 = s.dice(0, 0, 0.2, 0.6) * s.w, y0 = s.dice(0, 1, 0.1, 0.5) * s.h;
  const double w = s.dice(0, 2, 0.06, 0.25) * s.w, h = s.dice(0, 3, 0.15, 0.45) * s.h, bright = s.dice(0, 4, 0.6, 3);
  const double lean = s.dice(0, 5, -0.4, 0.4), shadow = s.dice(0, 6, 0.1, 0.5);
  return [=](double x, double y) {
    const double cloud = 1 + 0.15 * std::sin(1.7 * s.t + 0.02 * x) + shadow * 0.3 * std::sin(0.11 * y + 5 * s.t);
    const double narrow = lean * (y0 + h - y);  // seen from aside, or lit by a low sun: a wedge
    return over(Colour{0.03, 0.03, 0.04}, Colour{1, 0.95, 0.85} * (bright * cloud),
                box(x, y, x0 + std::max(narrow, 0.0), y0, w - std::abs(narrow), h, 2));
  };
}

// A lamp or a bulb of which the light goes as `level` says.
Light lit(const Stage& s, double level) {
  const double size = s.h * s.dice(0, 0, 0.05, 0.25), cx = s.w * s.dice(0, 1, 0.35, 0.65),
               cy = s.h * s.dice(0, 2, 0.35, 0.6);
  const double tall = s.dice(0, 3, 1, 2.6), point = s.dice(0, 4, 0, 0.9), halo = s.dice(0, 5, 0, 0.1),
               bright = s.dice(0, 6, 0.8, 5);
  const Colour colour{1, s.dice(0, 7, 0.7, 1), s.dice(0, 8, 0.4, 1)};
  const double shake = s.dice(0, 9) < 0.25 ? 1.5 : 0;
  const double sx = shake * std::sin(5 * s.t), sy = shake * std::cos(3.7 * s.t);
  return [=](double x, double y) {
    const double up = std::clamp((cy + tall * size - (y + sy)) / (2 * tall * size), 0.0, 1.0);
    const double bulb = disc(x + sx, y + sy, cx, cy, size * (1 - point * up), tall * size, 1.5);
    const double far = std::hypot(x - cx, y - cy) / size;
    const double stand = box(x + sx, y + sy, cx - 0.2 * size, cy + tall * size, 0.4 * size, s.h);
    Colour light = Colour{0.02, 0.02, 0.02} + colour * (level * halo * std::exp(-0.5 * std::max(0.0, far - tall)));
    light = over(light, Colour{0.06, 0.05, 0.04} * (1 + level), stand);
    return over(light, colour * (bright * level), bulb);
  };
}

Light lamp(const Stage& s) { return lit(s, 1); }
Light bulb(const Stage& s) {
  return lit(s, 1 + s.dice(9, 0, 0.02, 0.3) * std::sin(kTurn * 100 * s.t * (1 + s.dice(9, 1, -0.05, 0.05))));
}
Light dimmed(const Stage& s) { return lit(s, 0.55 + 0.45 * std::sin(s.dice(9, 0, 0.5, 4) * s.t)); }

Light cup(const Stage& s) {
  const double cx = s.w * s.dice(0, 0, 0.35, 0.65), cy = s.h * s.dice(0, 1, 0.4, 0.65),
               size = s.h * s.dice(0, 2, 0.1, 0.3);
  const double turn = 0.04 * size * std::sin(2 * s.t), bright = s.dice(0, 3, 0.3, 1.2), wide = s.dice(0, 4, 0.5, 1);
  return [=](double x, double y) {
    Colour light{0.12, 0.1, 0.09};
    const double side = 0.8 + 0.4 * (x - cx) / size;
    const double body = box(x, y, cx - wide * size + turn, cy - size, 2 * wide * size, 2 * size, 1.5);
    const double ear = disc(x, y, cx + wide * size + turn, cy, 0.4 * size, 0.6 * size) *
                       (1 - disc(x, y, cx + wide * size + turn, cy, 0.25 * size, 0.4 * size));
    return over(light, Colour{1, 1, 0.95} * (bright * side), std::max(body, ear));
  };
}

Light fireworks(const Stage& s) {
  struct Spark {
    double x, y, r, bright;
    Colour colour;
  };
  std::vector<Spark> sparks;
  for (int burst = 0; burst < 6; ++burst) {
    const double age = s.t - s.dice(burst, 0, -0.3, 2.6);
    if (age < 0 || age > 1.2) continue;
    const Colour colour{s.dice(burst, 3, 0.3, 1), s.dice(burst, 4, 0.3, 1), s.dice(burst, 5, 0.1, 1)};
    for (int k = 0; k < 24; ++k) {
      const double angle = kTurn * s.dice(100 * burst + k, 6),
                   reach = s.h * s.dice(100 * burst + k, 7, 0.1, 0.3) * (1 - std::exp(-3 * age));
      sparks.push_back({s.w * s.dice(burst, 1, 0.2, 0.8) + reach * std::cos(angle),
                        s.h * s.dice(burst, 2, 0.2, 0.6) + reach * std::sin(angle) + 0.06 * s.h * age * age,
                        0.012 * s.h, 3 * (1.2 - age), colour});
    }
  }
  return [=](double x, double y) {
    Colour light{0.005, 0.005, 0.01};
    for (const Spark& spark : sparks) {
      if (std::abs(x - spark.x) < 3 * spark.r && std::abs(y - spark.y) < 3 * spark.r)
        light = light + spark.colour * (spark.bright * disc(x, y, spark.x, spark.y, spark.r, spark.r, 2));
    }
    return light;
  };
}

// A wall, or a chimney, lit by a fire that is not in the picture.
Light glow(const Stage& s) {
  const double cx = s.w * s.dice(0, 0, 0.3, 0.7), cy = s.h * s.dice(0, 1, 0.5, 1.1),
               reach = s.h * s.dice(0, 2, 0.15, 0.5);
  const double flicker = 0.6 + 0.25 * std::sin(11 * s.t + 1) * std::sin(4.3 * s.t) + 0.15 * std::sin(23 * s.t),
               bright = s.dice(0, 3, 0.4, 2.5);
  return [=](double x, double y) {
    const double far = std::hypot(x - cx, 0.8 * (y - cy)) / reach;
    return Colour{0.01, 0.008, 0.008} + Colour{1, 0.5, 0.15} * (bright * flicker * std::exp(-far * far));
  };
}

Light flag(const Stage& s) {
  const double x0 = s.w * s.dice(0, 0, 0.1, 0.4), y0 = s.h * s.dice(0, 1, 0.15, 0.4), w = s.w * s.dice(0, 2, 0.25, 0.5),
               h = s.h * s.dice(0, 3, 0.15, 0.4);
  const Colour cloth{s.dice(0, 4, 0.4, 1.2), s.dice(0, 5, 0.2, 1.1), s.dice(0, 6, 0.1, 0.9)};
  const double taper = s.dice(0, 7), ground = s.dice(0, 8, 0.02, 0.3), speed = s.dice(0, 9, 4, 9);
  return [=](double x, double y) {
    const double along = std::clamp((x - x0) / w, 0.0, 1.0), phase = 0.07 * (x - x0) - speed * s.t;
    const double wave = 0.15 * h * along * std::sin(phase), shade = 0.85 + 0.2 * std::cos(phase);
    const double narrow = 0.4 * taper * h * along;
    const Colour light =
        over(Colour{0.8, 0.9, 1} * ground, Colour{0.2, 0.2, 0.2}, box(x, y, x0 - 3, 0.1 * s.h, 3, s.h));
    return over(light, cloth * shade,
                box(x, y, x0, y0 + wave + narrow, w * (1 + 0.04 * std::sin(speed * s.t)), h - 2 * narrow));
  };
}

struct Kind {
  const char* name;
  Light (*light)(const Stage&);
};

constexpr std::array<Kind, 12> kKinds{{{"street", street},
                                       {"cartoon", cartoon},
                                       {"tree", tree},
                                       {"sky", sky},
                                       {"pane", pane},
                                       {"lamp", lamp},
                                       {"bulb", bulb},
                                       {"dimmed", dimmed},
                                       {"cup", cup},
                                       {"fireworks", fireworks},
                                       {"glow", glow},
                                       {"flag", flag}}};

}  // namespace

std::vector<std::string> no_flame_kinds() {
  std::vector<std::string> out;
  for (const Kind& kind : kKinds) out.emplace_back(kind.name);
  return out;
}

std::vector<std::uint8_t> film(const NoFlame& scene, int k) {
  const auto kind = std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& one) { return one.name == scene.kind; });
  const Dice dice{scene.seed};
  // One film in four is a crop of a larger picture.
  const double crop = dice(1000, 0) < 0.25 ? dice(1000, 1, 1.3, 2.2) : 1, w = crop * scene.width,
               h = crop * scene.height;
  const double left = dice(1000, 2) * (w - scene.width), top = dice(1000, 3) * (h - scene.height);
  const Light light = kind->light({dice, w, h, k / scene.rate_hz});
  const double exposure = std::exp(dice(1000, 4, -0.6, 0.6)), grain = dice(1000, 5, 0.5, 4);
  std::mt19937 random(1000 * scene.seed + static_cast<unsigned>(k));
  std::normal_distribution<double> normal(0, grain);
  std::vector<std::uint8_t> rgb;
  rgb.reserve(static_cast<std::size_t>(scene.width) * scene.height * 3);
  for (int y = 0; y < scene.height; ++y) {
    for (int x = 0; x < scene.width; ++x) {
      const Colour colour = light(left + x, top + y) * exposure;
      for (const double value : {colour.r, colour.g, colour.b}) {
        const double level = 255 * std::pow(std::clamp(value, 0.0, 1.0), 1 / 2.2) + normal(random);
        rgb.push_back(static_cast<std::uint8_t>(std::clamp(level + 0.5, 0.0, 255.0)));
      }
    }
  }
  return rgb;
}

}  // namespace wisp::scenes
