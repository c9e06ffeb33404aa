#pragma once
// The Markov chain of a switched ARX model, compiled for stepping.

#include <cstdint>
#include <span>

#include "run/state/arena.hpp"
#include "wisp/model/switched.hpp"

namespace wisp {

inline constexpr std::uint32_t kAnyWord = 0xffffffffU;

struct ModeProgram {
  int modes = 0;
  int outputs = 0;
  /// (modes + 1) × modes, from every mode and from before the first step; a random word goes to the first mode whose
  /// threshold is above it, or is kAnyWord.
  std::span<std::uint32_t> thresholds;
};

/// Lays the program out and, unless the arena measures, fills it.
ModeProgram make_mode_program(const SwitchedArxModel& switched, Arena& arena);

/// A hash of the program, over a hash of what came before.
std::uint64_t hash_of(const ModeProgram& program, std::uint64_t before);

}  // namespace wisp
