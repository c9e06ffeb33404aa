#pragma once
// Made-up bouncing for tests: a ball that is thrown up again by chance whenever it lands, and wanders over ground.

#include <cmath>
#include <random>

#include "wisp/record/recording.hpp"

namespace wisp::chain {

struct MadeBallOptions {
  int rows = 6000;
  double floor = 0;     ///< metres
  double climb_sd = 0;  ///< metres: by chance, from one bounce to the next the floor moves so far
  double climb = 0;     ///< and always so far
  std::uint64_t seed = 1;
};

/// One episode at 60 rows a second; heights of the bounces are 0.6 to 1.2 m.
inline Recording made_ball(const MadeBallOptions& options = {}) {
  constexpr double kGravity = 9.81, kRate = 60;
  std::mt19937_64 random(options.seed);
  const auto share = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  Recording recording;
  recording.source = "ball.csv";
  recording.rate_hz = kRate;
  for (const char* name : {"pos.x", "pos.y", "pos.z"}) recording.channels.push_back({name, "m", Role::kOutput, {}});
  double x = 0, y = 0, heading = 0, floor = options.floor, speed = 0, since = 0, flight = 0;
  for (int row = 0; row < options.rows; ++row, since += 1 / kRate) {
    if (since >= flight) {
      since = std::max(0.0, since - flight);
      heading += 0.5 * (share() - 0.5);
      floor += options.climb + options.climb_sd * std::sqrt(12.0) * (share() - 0.5);
      speed = std::sqrt(2 * kGravity * (0.6 + 0.6 * share()));
      flight = 2 * speed / kGravity;
    }
    x += std::cos(heading) / kRate;
    y += std::sin(heading) / kRate;
    const double at[] = {x, y, floor + since * (speed - kGravity * since / 2)};
    for (std::size_t k = 0; k < 3; ++k) recording.channels[k].samples.push_back(at[k]);
  }
  recording.episode_ids.assign(static_cast<std::size_t>(options.rows), 0);
  return recording;
}

}  // namespace wisp::chain
