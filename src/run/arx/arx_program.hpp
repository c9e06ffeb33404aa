#pragma once
// The regression of an ARX model, or of the K modes of a switched one, compiled for stepping: coefficients in single
// precision and channel units, interleaved by mode, without taps that are zero in every mode, in the order of
// summation. Lanes in different modes therefore do the same operations in the same order.

#include <cstdint>
#include <span>
#include <vector>

#include "run/arx/resampled_program.hpp"
#include "run/state/arena.hpp"
#include "run/state/channels.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/model/switched.hpp"

namespace wisp {

/// Descending consecutive lags of one channel. Each has a nonzero coefficient in at least one mode.
struct TapRun {
  std::uint32_t channel;    ///< outputs first, then regressors
  std::uint32_t first_lag;  ///< largest lag of the run
  std::uint32_t count;
  std::uint32_t coefficient;  ///< index of the run's first tap; ArxProgram::coefficients has `modes` numbers per tap
};

struct ArxProgram {
  int outputs = 0;
  int regressors = 0;
  int depth = 0;  ///< number of stored samples, the one being made included
  int modes = 1;
  std::size_t shocks = 0;  ///< number of shocks of all outputs; known while measuring too, when arrays are empty
  std::span<TapRun> runs;
  std::span<std::uint32_t> row_end;    ///< per output, one past its last run
  std::span<std::uint32_t> twin;       ///< per output, number of taps if the next output has the same taps, else 0
  std::span<float> coefficients;       ///< taps × modes; those of A are negated: a step only adds
  std::span<float> constant;           ///< outputs × modes
  std::span<std::uint32_t> shock;      ///< per shock, index of the standard normal number (one per output) it scales
  std::span<std::uint32_t> shock_end;  ///< per output, one past its last shock
  std::span<float> shock_size;         ///< shocks × modes
  ResampledProgram resampled;          ///< residuals that replace Gaussian shocks; empty: Gaussian shocks
};

/// A tap's or shock's coefficient in every mode, in channel units.
struct ModeWeights {
  std::uint32_t channel;  ///< for a tap as in TapRun; for a shock the index of the standard normal number it scales
  std::uint32_t lag;
  std::vector<float> of_mode;
};

/// A regression in channel units, from which the arrays of an ArxProgram are filled.
struct Regression {
  std::vector<std::vector<ModeWeights>> taps;    ///< per output
  std::vector<std::vector<ModeWeights>> shocks;  ///< per output
  std::vector<float> constant;                   ///< outputs × modes
  int modes = 1;
  int history = 0;
  int regressors = 0;
};

Regression regression_of(const Model& model, const ArxModel& arx);
Regression regression_of(const Model& model, const SwitchedArxModel& switched);

/// Converts a number to single precision; to 0 if its magnitude is below kMinCoefficient.
float kept(double value);

/// Appends the weights unless they are zero in every mode.
void keep(std::vector<ModeWeights>& list, ModeWeights weights);

ArxProgram make_arx_program(const Model& model, const ArxModel& arx, Arena& arena);
ArxProgram make_arx_program(const Model& model, const SwitchedArxModel& switched, Arena& arena);

std::uint64_t hash_of(const ArxProgram& program, std::uint64_t before);

/// Checks that no step can overflow single precision. Errors: coefficients too large for that.
Result<void> check_regression(const Regression& regression);

}  // namespace wisp
