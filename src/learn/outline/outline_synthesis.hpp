#pragma once
// Synthesizes recordings by free play of a model, with the same code that plays it in a game.

#include <cstddef>
#include <cstdint>

#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

struct SynthesisOptions {
  std::size_t rows = 0;              ///< number of samples to keep; 0: as many as `input` has
  double warm_up_seconds = 10;       ///< ≥ 0; duration of the start's transient, which is discarded
  float noise = 1;                   ///< scale of the residual noise: 1 as learned, 0 none
  std::uint64_t seed = 1;            ///< seed of the bank
  const Recording* input = nullptr;  ///< channels named as the inputs, in the model's units, played in a loop; missing
                                     ///< samples are 0; null: all inputs are 0
};

/// A synthesized recording, and the share of clamped steps.
struct Synthesis {
  Recording recording;    ///< one channel per output, in the model's units, one episode
  double held_share = 0;  ///< share of steps with an output clamped to its range, without the warm-up
};

/// Plays a model in a bank with one instance. Errors: as Bank::create(); an input that is missing from the recording.
Result<Synthesis> synthesize(const Model& model, const SynthesisOptions& options);

}  // namespace wisp
