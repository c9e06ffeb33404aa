#include <cmath>

#include "run/arx/mode_lanes.hpp"
#include "run/state/model_hash.hpp"

namespace wisp {
namespace {

// Converts probabilities to cumulative ones, as 32-bit words; kAnyWord from the last mode of positive probability on.
void fill_thresholds(std::span<const double> probabilities, std::uint32_t* thresholds) {
  double sum = 0;
  std::size_t last = 0;
  for (std::size_t k = 0; k < probabilities.size(); ++k) {
    if (probabilities[k] > 0) last = k;
  }
  for (std::size_t k = 0; k < probabilities.size(); ++k) {
    sum += probabilities[k];
    const double words = std::min(std::floor(sum * 4294967296.0), static_cast<double>(kAnyWord - 1));
    thresholds[k] = k >= last ? kAnyWord : static_cast<std::uint32_t>(words);
  }
}

}  // namespace

ModeProgram make_mode_program(const SwitchedArxModel& switched, Arena& arena) {
  const std::size_t modes = switched.modes.size();
  ModeProgram program{static_cast<int>(modes), switched.orders.outputs(),
                      arena.take<std::uint32_t>((modes + 1) * modes)};
  if (arena.measures()) return program;
  for (std::size_t k = 0; k < modes; ++k) {
    fill_thresholds(std::span(switched.transitions).subspan(k * modes, modes), &program.thresholds[k * modes]);
  }
  fill_thresholds(switched.initial, &program.thresholds[modes * modes]);
  return program;
}

std::uint64_t hash_of(const ModeProgram& program, std::uint64_t before) {
  std::uint64_t hash = hash_number(static_cast<std::uint32_t>(program.modes), before);
  for (std::uint32_t word : program.thresholds) hash = hash_number(word, hash);
  return hash;
}

}  // namespace wisp
