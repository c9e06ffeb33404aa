// The candle rig against its reference figures: docs/studies/candle-rig.md explains each of them. About a quarter of an
// hour of one core. Prints tables; exit status 1 where a bound is missed.
//
//   wisp_verify_rig [NAME…]    calm wind step blow-out long-run lives resolution cost; default all

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "simulate/candle/candle_rig.hpp"
#include "simulate/candle/flame_outline.hpp"
#include "simulate/candle/wind_signal.hpp"
#include "studies/verify_bounds.hpp"

namespace {

using namespace wisp;
using verify::Bounds;

struct Named {
  const char* name;
  CandleRigOptions options;
};
// The rig's own grid, and a finer one with calibrated values of its own.
constexpr std::array kGrids = {Named{"R", {}}, Named{"M",
                                                     {.columns = 112,
                                                      .rows = 192,
                                                      .cell_mm = 1.25 / 3,
                                                      .steps_a_second = 600,
                                                      .wick_damping = 250,
                                                      .wick_cold = 450,
                                                      .wick_warm = 750,
                                                      .fuel_rate = 1.4e-4}}};

CandleRig rig_with(const CandleRigOptions& options) {
  auto rig = CandleRig::create(options);
  if (!rig) std::printf("%s\n", rig.error().message.c_str());
  return std::move(*rig);
}

int frames(const CandleRig& rig, double seconds) {
  return static_cast<int>(std::lround(seconds * rig.options().rate_hz));
}

void let_burn(CandleRig& rig, double seconds, double wind) {
  for (int frame = 0; frame < frames(rig, seconds); ++frame) rig.step_frame(wind);
}

/// Means over a stretch of frames.
struct Means {
  double lean = 0, tip = 0, brightness = 0, variation = 0;
  int with_flame = 0, frames = 0;
};

Means watch(CandleRig& rig, int count, const auto& wind) {
  Means m;
  double squares = 0;
  for (int frame = 0; frame < count; ++frame) {
    rig.step_frame(wind(frame));
    const FlameOutline outline = flame_outline(rig.light_of_frame());
    ++m.frames;
    m.brightness += outline.brightness;
    squares += outline.brightness * outline.brightness;
    if (!outline.found) continue;
    ++m.with_flame;
    m.lean += outline.lean;
    m.tip += outline.tip.y;
  }
  m.brightness /= m.frames;
  m.variation = std::sqrt(std::max(0.0, squares / m.frames - m.brightness * m.brightness)) / m.brightness;
  for (double* value : {&m.lean, &m.tip}) *value /= std::max(1, m.with_flame);
  return m;
}

void calm(Bounds& bounds) {
  std::printf("\nCalm flame, 4 s after 2 s\n");
  for (const Named& grid : kGrids) {
    CandleRig rig = rig_with(grid.options);
    let_burn(rig, 2, 0);
    const Means m = watch(rig, frames(rig, 4), [](int) { return 0.0; });
    std::printf("  %s: tip %.1f mm above the rim, brightness varies %.2f %%\n", grid.name, m.tip, 100 * m.variation);
    const std::string name = grid.name;
    bounds.at_least(name + ": height of the tip, mm", m.tip, 20);
    bounds.at_most(name + ": height of the tip, mm", m.tip, 40);
    bounds.at_most(name + ": brightness varies, %", 100 * m.variation, 3);
  }
}

// Lean and height against wind as the reference rig had them.
struct WindRow {
  double wind, lean, tip;
};
constexpr std::array kWindTable = {WindRow{0, 2, 32},      WindRow{0.15, 9, 30},  WindRow{0.3, 17, 28},
                                   WindRow{0.5, 27, 25},   WindRow{0.75, 37, 21}, WindRow{1, 46, 18},
                                   WindRow{1.25, 53, 13.5}};

void wind(Bounds& bounds) {
  std::printf("\nSteady wind (reached in 0.8 s, then 1.2 s): found and reference\n");
  for (const Named& grid : kGrids)
    for (const WindRow& row : kWindTable) {
      CandleRig rig = rig_with(grid.options);
      let_burn(rig, 0.5, 0);
      const int rise = frames(rig, 0.8);
      for (int frame = 0; frame < rise; ++frame) rig.step_frame(row.wind * frame / rise);
      let_burn(rig, 1.2, row.wind);
      const Means m = watch(rig, frames(rig, 1), [&](int) { return row.wind; });
      std::printf("  %s: %.2f m/s: lean %5.1f° (%.0f), tip %5.1f mm (%.1f), brightness varies %.1f %%\n", grid.name,
                  row.wind, m.lean, row.lean, m.tip, row.tip, 100 * m.variation);
      const std::string name = std::string(grid.name) + " at " + std::to_string(row.wind).substr(0, 4) + " m/s: ";
      bounds.at_most(name + "lean off by, % (1° allowed in calm air)",
                     100 * std::max(0.0, std::abs(m.lean - row.lean) - (row.wind > 0 ? 0 : 1)) / row.lean, 25);
      bounds.at_most(name + "tip's height off by, %", 100 * std::abs(m.tip - row.tip) / row.tip, 25);
    }
}

// The time after a step of wind at which the tip has gone a share of its way, in ms.
double time_of(const std::vector<double>& x, double share, double rate_hz) {
  double last = 0;
  const std::size_t tail = x.size() / 4;
  for (std::size_t k = x.size() - tail; k < x.size(); ++k) last += x[k] / static_cast<double>(tail);
  const double wanted = x[0] + share * (last - x[0]);
  std::size_t k = 1;
  while (k + 1 < x.size() && x[k] < wanted) ++k;
  return 1000 * (static_cast<double>(k) - 1 + (wanted - x[k - 1]) / (x[k] - x[k - 1])) / rate_hz;
}

void step(Bounds& bounds) {
  constexpr double kWind = 0.3;
  std::printf("\nA step of wind to %.1f m/s: the tip's way sideways at 10, 50, 90 %%, ms; reference 35, 78, 144\n",
              kWind);
  for (const Named& grid : kGrids) {
    CandleRigOptions options = grid.options;
    options.rate_hz = 120;
    CandleRig rig = rig_with(options);
    let_burn(rig, 2, 0);
    std::vector<double> x = {flame_outline(rig.light_of_frame()).tip.x};
    for (int frame = 0; frame < frames(rig, 1.2); ++frame) {
      rig.step_frame(kWind);
      x.push_back(flame_outline(rig.light_of_frame()).tip.x);
    }
    const std::string name = grid.name;
    for (const auto& [share, reference] : {std::pair{0.1, 35.0}, {0.5, 78.0}, {0.9, 144.0}}) {
      const double found = time_of(x, share, options.rate_hz);
      std::printf("  %s: %.0f %%: %.0f ms\n", grid.name, 100 * share, found);
      bounds.at_most(name + ": time to " + std::to_string(static_cast<int>(100 * share)) + " % off by, %",
                     100 * std::abs(found - reference) / reference, 25);
    }
  }
}

struct Puff {
  double wind, seconds;
  bool kills;
};
constexpr std::array kPuffs = {Puff{3, 0.1, true}, Puff{2, 0.2, true}, Puff{1.5, 0.4, true}, Puff{1, 0.4, false}};

void blow_out(Bounds& bounds) {
  std::printf("\nPuffs at a calm flame, and lighting again\n");
  for (const Named& grid : kGrids)
    for (const Puff& puff : kPuffs) {
      CandleRig rig = rig_with(grid.options);
      let_burn(rig, 1.5, 0);
      const double height = flame_outline(rig.light_of_frame()).tip.y;
      let_burn(rig, puff.seconds, puff.wind);
      let_burn(rig, 2, 0);
      const bool out = !rig.state().lit && !flame_outline(rig.light_of_frame()).found;
      std::printf("  %s: %.1f m/s for %.1f s: %s\n", grid.name, puff.wind, puff.seconds, out ? "out" : "lives");
      const std::string name = std::string(grid.name) + ": " + std::to_string(puff.wind).substr(0, 3) + " m/s for " +
                               std::to_string(puff.seconds).substr(0, 3) + " s: ";
      if (!puff.kills) {
        bounds.at_most(name + "is out", out ? 1 : 0, 0);
        continue;
      }
      bounds.at_least(name + "is out", out ? 1 : 0, 1);
      rig.light();
      let_burn(rig, 0.6, 0);
      const double again = flame_outline(rig.light_of_frame()).tip.y;
      bounds.at_least(name + "height 0.6 s after lighting, % of before", 100 * again / height, 85);
      bounds.at_least(name + "burns on 0.6 s after lighting", rig.state().lit ? 1 : 0, 1);
    }
}

void long_run(Bounds& bounds) {
  std::printf("\nTen minutes in gusts of up to 3 m/s from both sides, lit again half a second after each death\n");
  WindSignalOptions options;
  options.most = 3;
  options.noise = 1;
  options.gust = 2;
  options.both_sides = true;
  options.seed = 7;
  const WindSignal signal = *WindSignal::generate(options, 600);
  CandleRig rig = rig_with({});
  constexpr int kLighting = 30;  // frames from the lighter's first until its own heat has risen out of the picture
  double hottest = 0;
  double hottest_lighting = 0;
  double fastest = 0;
  int deaths = 0;
  int dark = 0;
  int burning = 0;
  bool finite = true;
  for (int frame = 0; frame < 600 * 60; ++frame) {
    rig.step_frame(signal.at(frame / 60.0));
    const CandleState state = rig.state();
    double& warmest = burning++ < kLighting ? hottest_lighting : hottest;
    warmest = std::max(warmest, state.hottest);
    fastest = std::max(fastest, state.fastest);
    finite = finite && state.finite;
    dark = state.lit ? 0 : dark + 1;
    if (dark != 30) continue;
    ++deaths;
    rig.light();
    dark = burning = 0;
  }
  std::printf("  hottest %.0f K, while lit by the lighter %.0f K, fastest %.1f m/s, lit again %d times\n", hottest,
              hottest_lighting, fastest, deaths);
  bounds.at_least("all numbers finite", finite ? 1 : 0, 1);
  bounds.at_most("hottest, K", hottest, 2300);
  // What the lighter holds at 1500 K, and then burns on top of that.
  bounds.at_most("hottest while the lighter heats, K", hottest_lighting, 1500 + 1700);
  bounds.at_most("fastest, m/s", fastest, 6);
  bounds.at_least("went out and was lit again, times", deaths, 3);
}

void lives(Bounds& bounds) {
  std::printf("\nThe default wind, 40 s of each seed: the flame lives\n");
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    WindSignalOptions options;
    options.seed = seed;
    const WindSignal signal = *WindSignal::generate(options, 40);
    CandleRig rig = rig_with({});
    let_burn(rig, 1.5, 0);
    const Means m = watch(rig, 40 * 60, [&](int frame) { return signal.at((frame + 1) / 60.0); });
    std::printf("  seed %d: mean lean %.1f°, mean tip %.1f mm, brightness varies %.0f %%\n", static_cast<int>(seed),
                m.lean, m.tip, 100 * m.variation);
    bounds.at_most("seed " + std::to_string(seed) + ": frames without a flame", m.frames - m.with_flame, 0);
  }
}

void resolution(Bounds& bounds) {
  std::printf("\nHalf the cell, half the step: means over 10 s of the default wind, seed 3\n");
  WindSignalOptions options;
  options.seed = 3;
  const WindSignal signal = *WindSignal::generate(options, 10);
  for (const Named& grid : kGrids) {
    const CandleRigOptions whole = grid.options;
    CandleRigOptions half_step = whole;
    half_step.steps_a_second *= 2;
    CandleRigOptions half_cell = whole;
    half_cell.columns *= 2;
    half_cell.rows *= 2;
    half_cell.cell_mm /= 2;
    std::vector<Means> found;
    for (const CandleRigOptions& o : {whole, half_step, half_cell}) {
      CandleRig rig = rig_with(o);
      let_burn(rig, 1.5, 0);
      found.push_back(watch(rig, 600, [&](int frame) { return signal.at((frame + 1) / 60.0); }));
      std::printf("  %s: cell %.3f mm, %.0f steps a second: lean %.2f°, tip %.2f mm, %d of %d frames with a flame\n",
                  grid.name, o.cell_mm, o.steps_a_second, found.back().lean, found.back().tip, found.back().with_flame,
                  found.back().frames);
    }
    const std::array names = {"", "half the step", "half the cell"};
    for (std::size_t k = 1; k < found.size(); ++k) {
      const std::string name = std::string(grid.name) + ", " + names[k] + ": ";
      bounds.at_most(name + "height changes, %", 100 * std::abs(found[k].tip / found[0].tip - 1), 15);
      bounds.at_most(name + "lean changes, %", 100 * std::abs(found[k].lean / found[0].lean - 1), 15);
    }
  }
}

}  // namespace

int main(int count, char** names) {
  struct Check {
    const char* name;
    void (*run)(Bounds&);
  };
  constexpr std::array kChecks = {Check{"calm", calm},
                                  Check{"wind", wind},
                                  Check{"step", step},
                                  Check{"blow-out", blow_out},
                                  Check{"resolution", resolution},
                                  Check{"lives", lives},
                                  Check{"long-run", long_run}};
  Bounds bounds;
  for (const Check& check : kChecks) {
    const auto wanted = [&](const char* name) { return std::string(name) == check.name; };
    if (count > 1 && std::none_of(names + 1, names + count, wanted)) continue;
    check.run(bounds);
  }
  std::printf("\n%d bounds missed\n", bounds.missed());
  return bounds.missed() == 0 ? 0 : 1;
}
