#include "learn/outline/outline_fidelity.hpp"

#include <algorithm>

#include "learn/outline/outline_synthesis.hpp"

namespace wisp {
namespace {

constexpr std::size_t kWindows = 120;  // a side: the distance is known to 0.01 then, for a hundredth of a second
constexpr double kPlayed = 30;         // seconds at least

}  // namespace

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
