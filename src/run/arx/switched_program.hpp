#pragma once
// A switched ARX model compiled for stepping: what is zero in every mode is left out, and what is left lies mode beside
// mode, so that lanes in different modes do the same operations in the same order.

#include <cstdint>
#include <span>

#include "run/bank/arena.hpp"
#include "run/bank/channels.hpp"
#include "wisp/model/switched.hpp"

namespace wisp {

/// A past sample that something is multiplied with.
struct SwitchedTap {
  std::uint32_t channel;  ///< outputs first, then regressors
  std::uint32_t lag;
};

inline constexpr std::uint32_t kAnyWord = 0xffffffffU;

struct SwitchedProgram {
  int outputs = 0;
  int regressors = 0;
  int depth = 0;  ///< samples of history that are kept, the one being made included
  int modes = 0;
  bool markov = false;
  std::size_t shocks = 0;  ///< that are used; known while measuring, when all arrays are empty
  std::span<SwitchedTap> taps;
  std::span<std::uint32_t> row_end;    ///< per output, one past its last tap
  std::span<float> coefficients;       ///< taps × modes, those of A with their sign turned
  std::span<float> constant;           ///< outputs × modes
  std::span<std::uint32_t> shock;      ///< which of the standard shocks
  std::span<std::uint32_t> shock_end;  ///< per output, one past its last
  std::span<float> shock_size;         ///< shocks × modes
  std::span<SwitchedTap> region_taps;  ///< for regions
  std::span<float> region_weights;     ///< modes × taps
  std::span<float> region_constant;    ///< per mode
  /// For a Markov chain: (modes + 1) × modes, from every mode and from before the first step; a random word goes to the
  /// first mode whose threshold is above it, or is kAnyWord.
  std::span<std::uint32_t> thresholds;
};

/// Lays the program out and, unless the arena measures, fills it.
SwitchedProgram make_switched_program(const Model& model, const SwitchedArxModel& switched, Arena& arena);

/// A hash of the program, over a hash of what came before.
std::uint64_t hash_of(const SwitchedProgram& program, std::uint64_t before);

/// Errors: coefficients so large that a step could overflow single precision.
Result<void> check_switched_program(const Model& model, const SwitchedArxModel& switched);

}  // namespace wisp
