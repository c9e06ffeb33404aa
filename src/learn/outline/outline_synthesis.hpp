#pragma once
// What a model does when it is left to itself: recordings made by the very code that plays it in a game.

#include <cstddef>
#include <cstdint>

#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// How to play.
struct SynthesisOptions {
  std::size_t rows = 0;              ///< samples to keep; 0: as many as `input` has
  double warm_up_seconds = 10;       ///< ≥ 0, played first and thrown away, so that the start is not seen
  float noise = 1;                   ///< scale of the residual noise: 1 as learned, 0 none
  std::uint64_t seed = 1;            ///< of the bank
  const Recording* input = nullptr;  ///< its channels of the inputs' names, in the model's units, again and again from
                                     ///< the start when it ends; null: inputs are 0
};

/// A synthesized recording and how often outputs were held.
struct Synthesis {
  Recording recording;    ///< one channel an output, in the model's units, one episode
  double held_share = 0;  ///< of steps in which an output was clamped to its range, the warm-up not counted
};

/// Plays a model in a bank of one.
/// Errors: as Bank::create(); an input that the recording has not or whose samples are missing.
Result<Synthesis> synthesize(const Model& model, const SynthesisOptions& options);

}  // namespace wisp
