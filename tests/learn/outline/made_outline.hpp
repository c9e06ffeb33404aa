#pragma once
// Recordings of an outline whose dynamics are known: every point a damped resonance about its place, shaken by shocks
// that all points share and leaned by wind, seen by a camera whose candle is carried about.

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "learn/outline/outline_units.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::made {

/// What is made.
struct OutlineRecipe {
  std::size_t points = 6;
  std::size_t rows = 4000;
  double rate_hz = 30;
  double lag1 = 1.5;  ///< x(t) = lag1 x(t−1) + lag2 x(t−2) + drive + shock
  double lag2 = -0.7;
  double shock = 0.01;     ///< standard deviation, in heights
  double own_share = 0.3;  ///< of a point's shock that no other has
  bool wind = false;       ///< gusts with rests, from both sides where `both_sides`
  bool both_sides = false;
  double lean = 0.02;    ///< of the tip, heights a frame at wind 1
  double wind_unit = 3;  ///< what the sensor says at wind 1
  std::uint64_t seed = 1;
};

inline double resting_x(std::size_t p, std::size_t points) {
  const double s = static_cast<double>(p) / static_cast<double>(points - 1);
  return -0.15 * std::cos(3.14159265358979 * s);
}

inline double resting_y(std::size_t p, std::size_t points) {
  const double s = static_cast<double>(p) / static_cast<double>(points - 1);
  return 1.3 * std::sin(3.14159265358979 * s);
}

/// Smooth gusts with rests between them, one wind a row.
inline std::vector<double> gusts(const OutlineRecipe& recipe) {
  std::mt19937_64 random(recipe.seed + 1000);
  std::normal_distribution<double> gauss;
  std::vector<double> out;
  double level = 0;
  double smooth = 0;
  for (std::size_t t = 0; t < recipe.rows; ++t) {
    const std::size_t second = t / static_cast<std::size_t>(recipe.rate_hz);
    level += 0.2 * (0.5 + 0.8 * gauss(random) - level);
    const double target = second % 3 == 2 ? 0 : std::max(0.0, level);
    smooth += 0.4 * (target - smooth);
    const double side = recipe.both_sides && second % 2 == 1 ? -1 : 1;
    out.push_back(second % 3 == 2 && smooth < 0.01 ? 0 : side * smooth);
  }
  return out;
}

inline Recording outline_recording(const OutlineRecipe& recipe) {
  constexpr double kPixels = 200;
  std::mt19937_64 random(recipe.seed);
  std::normal_distribution<double> gauss;
  const auto wind = gusts(recipe);
  Recording out;
  out.source = "made " + std::to_string(recipe.seed);
  out.rate_hz = recipe.rate_hz;
  for (const std::string& name : outline_outputs(recipe.points))
    out.channels.push_back({name, "px", Role::kOutput, {}});
  std::vector<double> last(2 * recipe.points, 0.0);
  std::vector<double> before = last;
  constexpr std::size_t kWarmUp = 200;
  for (std::size_t t = 0; t < recipe.rows + kWarmUp; ++t) {
    const double together[] = {gauss(random), gauss(random)};  // a lean and a stretch
    const double u = t < kWarmUp || !recipe.wind ? 0 : wind[t - kWarmUp];
    std::vector<double> now(last.size());
    for (std::size_t p = 0; p < recipe.points; ++p) {
      const double height = resting_y(p, recipe.points);
      for (std::size_t k = 0; k < 2; ++k) {
        const std::size_t c = 2 * p + k;
        const double own = gauss(random);
        // The base is held by the wick: it moves little, as a whole not at all.
        const double reach = (p == 0 || p + 1 == recipe.points) ? 0.1 : 0.3 + height;
        const double shock = std::sqrt(1 - recipe.own_share) * together[k] + std::sqrt(recipe.own_share) * own;
        const double drive = k == 0 ? recipe.lean * u : -0.3 * recipe.lean * std::abs(u);
        now[c] = recipe.lag1 * last[c] + recipe.lag2 * before[c] + reach * recipe.shock * shock + height * drive;
      }
    }
    const std::size_t end = 2 * (recipe.points - 1);
    now[end] = -now[0];
    now[end + 1] = -now[1];
    before = last;
    last = now;
    if (t < kWarmUp) continue;
    const double base_x = 320 + 20 * std::sin(0.05 * static_cast<double>(t));
    for (std::size_t p = 0; p < recipe.points; ++p) {
      out.channels[2 * p].samples.push_back(base_x + kPixels * (resting_x(p, recipe.points) + now[2 * p]));
      out.channels[2 * p + 1].samples.push_back(400 - kPixels * (resting_y(p, recipe.points) + now[2 * p + 1]));
    }
  }
  if (!recipe.wind) return out;
  Channel heard{"wind", "m/s", Role::kInput, {}};
  for (double u : wind) heard.samples.push_back(recipe.wind_unit * u);
  out.channels.push_back(std::move(heard));
  return out;
}

}  // namespace wisp::made
