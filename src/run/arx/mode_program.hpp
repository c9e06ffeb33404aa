#pragma once
// What decides which mode of a switched ARX model acts, compiled for stepping.

#include <cstdint>
#include <span>

#include "run/state/arena.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// A past sample that the regions look at.
struct RegionTap {
  std::uint32_t channel;  ///< outputs first, then regressors
  std::uint32_t lag;
};

inline constexpr std::uint32_t kAnyWord = 0xffffffffU;

struct ModeProgram {
  int modes = 0;
  int outputs = 0;
  bool markov = false;
  std::span<RegionTap> region_taps;  ///< for regions
  std::span<float> region_weights;   ///< modes × taps
  std::span<float> region_constant;  ///< per mode
  /// For a Markov chain: (modes + 1) × modes, from every mode and from before the first step; a random word goes to the
  /// first mode whose threshold is above it, or is kAnyWord.
  std::span<std::uint32_t> thresholds;
};

/// Lays the program out and, unless the arena measures, fills it.
ModeProgram make_mode_program(const Model& model, const SwitchedArxModel& switched, Arena& arena);

/// A hash of the program, over a hash of what came before.
std::uint64_t hash_of(const ModeProgram& program, std::uint64_t before);

}  // namespace wisp
