#pragma once
// What a segment chain does without chance: it goes round in a loop. How soon, and how long a round is.

#include <cstddef>
#include <optional>

#include "wisp/model/model.hpp"

namespace wisp {

/// A walk that repeats itself.
struct ChainLoop {
  std::size_t lead = 0;      ///< segments that are played before the loop
  std::size_t segments = 0;  ///< of one round, ≥ 1
  double lead_seconds = 0;
  double seconds = 0;  ///< of one round
};

/// The loop in which every instance of a chain ends that is spawned after Bank::set_noise(0) has taken its chance away,
/// `history` as ChainFacet::set_history(). It allocates: not for every frame.
/// Returns nothing where the dynamics are not a chain, its modes are systems, or the model is not valid (check()).
std::optional<ChainLoop> chain_loop(const Model& model, int history = 0);

}  // namespace wisp
