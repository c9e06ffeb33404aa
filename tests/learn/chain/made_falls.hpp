#pragma once
// Made-up falls for tests: a pendulum that slides from side to side as it sinks, and turns with its swing.

#include <cmath>
#include <random>
#include <string>

#include "wisp/record/recording.hpp"

namespace wisp::chain {

struct MadeFallOptions {
  int falls = 10;
  double seconds = 6;
  double rate_hz = 60;
  bool orientation = true;
  double swing_seconds = 0.6;  ///< from stall to stall
  std::uint64_t seed = 1;
};

/// Falls along headings of their own. Every swing is between 0.8 and 1.2 times as long and wide as told.
inline Recording made_falls(const MadeFallOptions& options = {}) {
  std::mt19937_64 random(options.seed);
  const auto share = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  Recording recording;
  recording.source = "made.csv";
  recording.rate_hz = options.rate_hz;
  for (const char* name : {"pos.x", "pos.y", "pos.z"}) recording.channels.push_back({name, "m", Role::kOutput, {}});
  if (options.orientation) {
    for (const char* name : {"q.w", "q.x", "q.y", "q.z"}) recording.channels.push_back({name, "", Role::kOutput, {}});
  }
  for (int fall = 0; fall < options.falls; ++fall) {
    const double heading = 2 * std::acos(-1.0) * share();
    double phase = 0, wide = 0.2, quick = 1 / options.swing_seconds, place = 0, along = 0;
    int swing = -1;
    for (int row = 0; row < static_cast<int>(options.seconds * options.rate_hz); ++row) {
      if (static_cast<int>(std::floor(phase)) != swing) {
        swing = static_cast<int>(std::floor(phase));
        wide = 0.2 * (0.8 + 0.4 * share());
        quick = 1 / (options.swing_seconds * (0.8 + 0.4 * share()));
      }
      const double speed = wide * std::sin(std::acos(-1.0) * phase) * 3;
      along += speed / options.rate_hz;
      place -= (0.5 + std::abs(speed)) / options.rate_hz;
      const double tilt = 0.5 * std::cos(std::acos(-1.0) * phase);
      const double pose[] = {along * std::cos(heading),
                             along * std::sin(heading),
                             place,
                             std::cos(heading / 2 - std::acos(-1.0) / 4) * std::cos(tilt / 2),
                             std::cos(heading / 2 - std::acos(-1.0) / 4) * std::sin(tilt / 2),
                             std::sin(heading / 2 - std::acos(-1.0) / 4) * std::sin(tilt / 2),
                             std::sin(heading / 2 - std::acos(-1.0) / 4) * std::cos(tilt / 2)};
      for (std::size_t k = 0; k < recording.channels.size(); ++k) recording.channels[k].samples.push_back(pose[k]);
      recording.episode_ids.push_back(fall);
      phase += quick / options.rate_hz;
    }
  }
  return recording;
}

}  // namespace wisp::chain
