// What a gust does to the mean of an ensemble, and what chance does to its members.

#include <cstdio>
#include <cstdlib>

#include "studies/leaf/verify_leaf.hpp"
#include "wisp/simulate/leaf_drops.hpp"

namespace wisp::verify {
namespace {

constexpr std::size_t kRows = 90;

const std::vector<double>& samples(const Recording& recording, const char* name) {
  return recording.channels[*find_channel(recording, name)].samples;
}

// Velocity along a direction by central differences.
double velocity(const Recording& recording, std::size_t row, double x, double y) {
  const auto rate = [&](const char* name) {
    return (samples(recording, name)[row + 1] - samples(recording, name)[row - 1]) / 2 * recording.rate_hz;
  };
  return rate("pos.x") * x + rate("pos.y") * y;
}

}  // namespace

void gusts(Bounds& bounds) {
  std::printf("\nGusts of 0.3 s: change of velocity along the wind, over the gust's speed, 200 gusts of 32 clones\n");
  LeafPairsOptions options;
  options.drops.drops = 200;
  options.drops.seconds = kRows / 60.0;
  const auto pairs = simulate_leaf_pairs(options);
  if (!pairs) std::exit(1);
  std::array<Estimate, kRows> means, spreads;
  const auto &wind_x = samples(pairs->windy, "wind.x"), &wind_y = samples(pairs->windy, "wind.y");
  for (std::size_t gust = 0; gust < 200; ++gust) {
    std::array<Estimate, kRows> change;
    for (std::size_t clone = 0; clone < 32; ++clone) {
      const std::size_t begin = (gust * 32 + clone) * kRows;
      std::size_t onset = 0, peak = begin;
      for (std::size_t row = begin; row < begin + kRows; ++row) {
        const double here = std::hypot(wind_x[row], wind_y[row]);
        if (here > 0 && onset == 0) onset = row;
        if (here > std::hypot(wind_x[peak], wind_y[peak])) peak = row;
      }
      const double speed = std::hypot(wind_x[peak], wind_y[peak]);
      const double x = wind_x[peak] / speed, y = wind_y[peak] / speed;
      for (std::size_t row = onset; row + 1 < begin + kRows; ++row)
        change[row - onset].add((velocity(pairs->windy, row, x, y) - velocity(pairs->calm, row, x, y)) / speed);
    }
    for (std::size_t k = 0; k < kRows; ++k) {
      if (change[k].count() < 32) continue;
      means[k].add(change[k].mean());
      spreads[k].add(change[k].spread());
    }
  }
  double most = 0;
  for (std::size_t k = 0; k < 48; k += 3) {
    most = std::max(most, means[k].mean());
    std::printf("  %.2f s after the onset: mean %5.2f±%.2f, spread %.2f\n", static_cast<double>(k) / 60,
                means[k].mean(), means[k].error(), spreads[k].mean());
  }
  bounds.at_least("largest mean change, of the gust's speed", most, 0.8);
  bounds.at_most("largest mean change, of the gust's speed", most, 1.2);
  bounds.at_most("mean change 0.75 s after the onset", std::abs(means[45].mean()), 0.25);
  bounds.at_least("spread of the clones 0.75 s after the onset", spreads[45].mean(), 0.5);
}

}  // namespace wisp::verify
