#pragma once
// A chain over modes, with each mode's realisation. Source: section 2.2 of the paper, which names segments, splines,
// systems, differential equations and chains of their own.

#include <cstdint>
#include <span>
#include <vector>

#include "learn/chain/modes/mode_chain.hpp"
#include "learn/chain/segments/segmentation.hpp"
#include "wisp/model/chain.hpp"

namespace wisp::chain {

/// Recorded segments in their modes, and the chain of those.
struct ModeWalk {
  const Motion& motion;
  std::span<const Segment> segments;
  std::span<const std::uint16_t> cluster;
  int modes;
  const ModeChain& chain;
};

struct RealisedChain {
  ChainModel dynamics;
  std::vector<std::uint64_t> origin;  ///< as ChainFit's
};

/// Errors: as fit_mode_systems() and mode_parts().
Result<RealisedChain> realised_chain(const ModeWalk& walk, const ChainRecipe& recipe);

}  // namespace wisp::chain
