#include "learn/outline/outline_fidelity.hpp"

#include <algorithm>
#include <cmath>

#include "learn/outline/outline_synthesis.hpp"

namespace wisp {
namespace {

constexpr std::size_t kWindows = 120;  // a side: the distance is known to 0.01 then, for a hundredth of a second
constexpr double kPlayed = 30;         // seconds at least

struct Differences {
  double neighbours = 0;  // mean square
  double any = 0;
};

// Over pairs of whole samples; episodes are not kept separate, since one pair in hundreds lies across their ends.
Differences differences(const std::vector<double>& samples) {
  double sum = 0, squares = 0, steps = 0, count = 0, pairs = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (std::isnan(samples[k])) continue;
    sum += samples[k];
    squares += samples[k] * samples[k];
    ++count;
    if (k == 0 || std::isnan(samples[k - 1])) continue;
    steps += (samples[k] - samples[k - 1]) * (samples[k] - samples[k - 1]);
    ++pairs;
  }
  if (pairs == 0) return {};
  const double mean = sum / count;
  return {steps / pairs, 2 * std::max(0.0, squares / count - mean * mean)};
}

}  // namespace

double unsteadiness(const PreparedOutlines& prepared) {
  Differences all;
  for (const Recording& recording : prepared.recordings) {
    for (const std::string& name : prepared.channels.outputs) {
      const Differences one = differences(recording.channels[*find_channel(recording, name)].samples);
      all.neighbours += one.neighbours;
      all.any += one.any;
    }
  }
  return all.any > 0 ? all.neighbours / all.any : 0;
}

Result<std::optional<Bounded>> play_distance(const Model& model, const PreparedOutlines& prepared, std::size_t which,
                                             const Recording& driving, std::uint64_t seed) {
  const Recording& real = prepared.recordings[which];
  const std::size_t rows = std::max(real.rows(), static_cast<std::size_t>(kPlayed * model.rate_hz));
  const auto play = synthesize(model, {.rows = rows, .seed = seed, .input = &driving});
  if (!play) return play.error();
  const FidelityOptions how{.channels = prepared.channels.outputs, .max_windows = kWindows, .permutations = 0};
  const auto found = fidelity({&real, 1}, {&play->recording, 1}, how);
  if (!found) return std::optional<Bounded>();
  return std::optional<Bounded>(found->energy_distance);
}

}  // namespace wisp
