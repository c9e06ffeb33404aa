#include "run/chain/systems_program.hpp"

#include <algorithm>

#include "run/state/model_hash.hpp"

namespace wisp {

SystemsProgram make_systems_program(const ModeSystems& systems, Arena& arena) {
  SystemsProgram program;
  program.degree = systems.degree;
  program.terms = static_cast<std::uint32_t>(system_terms(systems.degree));
  const std::size_t modes = systems.modes.size();
  const bool noisy = !systems.modes.front().noise.empty();
  program.coefficient = arena.take<float>(modes * kSystemStates * program.terms);
  program.noise = arena.take<float>(noisy ? modes * kSystemStates * kSystemStates : 0);
  program.range = arena.take<float>(modes * kSystemStates * 2);
  program.steps = arena.take<std::uint16_t>(modes * kSystemDurations);
  if (arena.measures()) return program;
  const auto to_float = [](double x) { return static_cast<float>(x); };
  auto coefficient = program.coefficient.begin();
  auto noise = program.noise.begin();
  auto range = program.range.begin();
  auto steps = program.steps.begin();
  for (const ModeSystem& mode : systems.modes) {
    coefficient = std::transform(mode.coefficient.begin(), mode.coefficient.end(), coefficient, to_float);
    noise = std::transform(mode.noise.begin(), mode.noise.end(), noise, to_float);
    for (std::size_t k = 0; k < kSystemStates; ++k) {
      *range++ = to_float(mode.lowest[k]);
      *range++ = to_float(mode.highest[k]);
    }
    steps = std::copy(mode.steps.begin(), mode.steps.end(), steps);
  }
  return program;
}

std::uint64_t hash_of(const SystemsProgram& program, std::uint64_t before) {
  std::uint64_t hash = hash_number(static_cast<std::uint32_t>(program.degree), before);
  for (const auto& numbers : {program.coefficient, program.noise, program.range}) hash = hash_floats(numbers, hash);
  for (std::uint16_t steps : program.steps) hash = hash_number(std::uint32_t{steps}, hash);
  return hash;
}

}  // namespace wisp
