#pragma once
// Recordings in which a flame goes out by a known rule and is lit again.

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "learn/outline/made_outline.hpp"
#include "wisp/model/extinction.hpp"

namespace wisp::made {

/// What is made: gusts up to about 1 of the sensor's wind units, and every `every` seconds a puff over them, which
/// leans nothing.
struct BlowOutRecipe {
  Extinction rule{.level = 1.8, .seconds = 0.3, .haste = 2, .recovery = 0.4};
  std::size_t rows = 3600;
  double rate_hz = 60;
  double every = 4;      ///< seconds between puffs; 0: none
  double weakest = 1.2;  ///< of the puffs, in wind units,
  double strongest = 4;
  double shortest = 0.05;  ///< seconds; the longest last 0.6
  double hiss = 0.02;      ///< what the sensor adds to the wind, wind units
  double out = 1.5;        ///< seconds until it is lit again
  std::uint64_t seed = 1;
};

struct BlowOutRecording {
  Recording recording;                ///< wind in the sensor's unit: 3 is a wind of 1
  std::vector<std::size_t> deaths{};  ///< rows without an outline for the first time
};

inline constexpr double kWindUnit = 3;

/// Harm of the next row by the definition of the rule.
inline double next_harm(const Extinction& rule, double harm, double wind, double step) {
  const double w = std::min(wind, Extinction::kMaxWind * rule.level);
  const double rate = w >= rule.level ? (1 + rule.haste * (w / rule.level - 1)) / rule.seconds : -1 / rule.recovery;
  return std::max(0.0, harm + rate * step);
}

inline std::vector<double> puffed_wind(const BlowOutRecipe& recipe, std::vector<double> wind) {
  std::mt19937_64 random(recipe.seed + 77);
  std::uniform_real_distribution<double> strength(recipe.weakest, recipe.strongest), length(0, 1);
  if (recipe.every == 0) return wind;
  for (double at = recipe.every; at * recipe.rate_hz < static_cast<double>(wind.size()); at += recipe.every) {
    const double peak = strength(random), seconds = recipe.shortest * std::pow(0.6 / recipe.shortest, length(random));
    for (std::size_t k = 0; k < wind.size(); ++k) {
      const double t = static_cast<double>(k) / recipe.rate_hz - at;
      if (t >= 0 && t < seconds) wind[k] = std::max(wind[k], peak);
    }
  }
  return wind;
}

/// The outlines of outline_recording() with what the rule takes away.
inline BlowOutRecording blow_out_recording(const BlowOutRecipe& recipe) {
  OutlineRecipe outline{.rows = recipe.rows, .rate_hz = recipe.rate_hz, .wind = true, .seed = recipe.seed};
  const std::vector<double> wind = puffed_wind(recipe, gusts(outline));
  BlowOutRecording out{outline_recording(outline), {}};
  std::mt19937_64 random(recipe.seed + 5);
  std::normal_distribution<double> gauss;
  Channel& sensor = out.recording.channels[*find_channel(out.recording, "wind")];
  double harm = 0;
  std::size_t dark = 0;
  for (std::size_t row = 0; row < recipe.rows; ++row) {
    sensor.samples[row] = kWindUnit * std::abs(wind[row] + recipe.hiss * gauss(random));
    if (dark == 0) {
      harm = next_harm(recipe.rule, harm, wind[row], 1 / recipe.rate_hz);
      if (harm < 1) continue;
      harm = 0;
      dark = static_cast<std::size_t>(recipe.out * recipe.rate_hz);
      if (row + 1 < recipe.rows) out.deaths.push_back(row + 1);
      continue;
    }
    --dark;
    for (Channel& channel : out.recording.channels) {
      if (channel.role != Role::kInput) channel.samples[row] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return out;
}

}  // namespace wisp::made
