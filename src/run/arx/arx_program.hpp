#pragma once
// An ARX model compiled for stepping: coefficients in single precision and channel units, zeros left out, in the order
// in which every instance adds them up.

#include <cstdint>
#include <span>

#include "run/arx/drawn_program.hpp"
#include "run/bank/arena.hpp"
#include "run/bank/channels.hpp"
#include "wisp/model/arx.hpp"

namespace wisp {

/// Successive lags of one channel with coefficients that are not zero.
struct TapRun {
  std::uint32_t channel;  ///< outputs first, then regressors
  std::uint32_t first_lag;
  std::uint32_t count;
  std::uint32_t coefficient;  ///< index of the first
};

struct ArxProgram {
  int outputs = 0;
  int regressors = 0;
  int depth = 0;  ///< samples of history that are kept, the one being made included
  int rank = 0;
  std::span<TapRun> runs;
  std::span<std::uint32_t> row_end;  ///< per output, one past its last run
  std::span<float> coefficients;     ///< those of A with their sign turned: a step only adds
  std::span<float> constant;
  std::span<float> sd;
  std::span<float> mixing;  ///< outputs × rank
  DrawnProgram drawn;       ///< residuals to play instead; empty: Gaussian shocks
};

/// Lays the program out and, unless the arena measures, fills it.
ArxProgram make_arx_program(const Model& model, const ArxModel& arx, Arena& arena);

/// Marks the outputs that are always the negative of an earlier one: the two ends of an outline are, since the base's
/// middle lies between them.
void mark_mirrored(const ArxProgram& program, std::span<OutputChannel> outputs);

/// A hash of the program, over a hash of what came before.
std::uint64_t hash_of(const ArxProgram& program, std::uint64_t before);

/// Errors: coefficients so large that a step could overflow single precision.
Result<void> check_arx_program(const Model& model, const ArxModel& arx);

}  // namespace wisp
