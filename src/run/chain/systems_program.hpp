#pragma once
// Systems of modes compiled for stepping: in single precision, and laid out in one piece.

#include <cstdint>
#include <span>

#include "run/state/arena.hpp"
#include "wisp/model/mode_systems.hpp"

namespace wisp {

struct SystemsProgram {
  int degree = 0;  ///< 0: modes are not systems
  std::uint32_t terms = 0;
  std::span<float> coefficient;    ///< modes × 6 × terms
  std::span<float> noise;          ///< modes × 6 × 6, or empty
  std::span<float> range;          ///< modes × 6 × (lowest, highest)
  std::span<std::uint16_t> steps;  ///< modes × 16

  bool used() const { return degree > 0; }
};

SystemsProgram make_systems_program(const ModeSystems& systems, Arena& arena);

/// A hash of the program, over a hash of what came before.
std::uint64_t hash_of(const SystemsProgram& program, std::uint64_t before);

}  // namespace wisp
