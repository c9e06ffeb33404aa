#pragma once
// The regression of an ARX model, or of the K modes of a switched one, compiled for stepping: coefficients in single
// precision and channel units, mode beside mode, what is zero in every mode left out, in the order in which every
// instance adds them up. Lanes in different modes so do the same operations in the same order.

#include <cstdint>
#include <span>
#include <vector>

#include "run/arx/resampled_program.hpp"
#include "run/state/arena.hpp"
#include "run/state/channels.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/model/switched.hpp"

namespace wisp {

/// Lags of one channel, each one less than the one before, with coefficients that are not zero in every mode.
struct TapRun {
  std::uint32_t channel;    ///< outputs first, then regressors
  std::uint32_t first_lag;  ///< the longest
  std::uint32_t count;
  std::uint32_t coefficient;  ///< index of the first, in taps
};

struct ArxProgram {
  int outputs = 0;
  int regressors = 0;
  int depth = 0;  ///< samples of history that are kept, the one being made included
  int modes = 1;
  int shock_channels = 0;  ///< standard normal numbers that a step may draw
  std::size_t shocks = 0;  ///< that are added; known while measuring, when all arrays are empty
  std::span<TapRun> runs;
  std::span<std::uint32_t> row_end;    ///< per output, one past its last run
  std::span<std::uint32_t> twin;       ///< per output, its taps where the next has the same but for coefficients, or 0
  std::span<float> coefficients;       ///< taps × modes; those of A with their sign turned: a step only adds
  std::span<float> constant;           ///< outputs × modes
  std::span<std::uint32_t> shock;      ///< which of the standard normal numbers
  std::span<std::uint32_t> shock_end;  ///< per output, one past its last
  std::span<float> shock_size;         ///< shocks × modes
  ResampledProgram resampled;          ///< residuals to play instead; empty: Gaussian shocks
};

/// A number of every mode that one sample is multiplied with, in channel units.
struct ModeWeights {
  std::uint32_t channel;  ///< of a tap as in TapRun; of a shock which of the standard normal numbers
  std::uint32_t lag;
  std::vector<float> of_mode;
};

/// A regression in channel units, before it is laid out.
struct Regression {
  std::vector<std::vector<ModeWeights>> taps;    ///< per output
  std::vector<std::vector<ModeWeights>> shocks;  ///< per output
  std::vector<float> constant;                   ///< outputs × modes
  int modes = 1;
  int history = 0;
  int regressors = 0;
  int shock_channels = 0;
};

Regression regression_of(const Model& model, const ArxModel& arx);
Regression regression_of(const Model& model, const SwitchedArxModel& switched);

/// What the numbers of each channel are multiples of: outputs, then regressors.
std::vector<double> channel_units(const Model& model);

/// A number as the kernels have it: what is too small to matter is 0.
float kept(double value);

/// Appends what is not zero in every mode.
void keep(std::vector<ModeWeights>& list, ModeWeights weights);

/// Lays the program out and, unless the arena measures, fills it.
ArxProgram make_arx_program(const Model& model, const ArxModel& arx, Arena& arena);
ArxProgram make_arx_program(const Model& model, const SwitchedArxModel& switched, Arena& arena);

/// A hash of the program, over a hash of what came before.
std::uint64_t hash_of(const ArxProgram& program, std::uint64_t before);

/// Errors: coefficients so large that a step could overflow single precision.
Result<void> check_regression(const Regression& regression);

}  // namespace wisp
