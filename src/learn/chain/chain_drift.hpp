#pragma once
// Where a chain's walk leads, from its stored segments: what it is steered by.

#include "wisp/model/chain.hpp"

namespace wisp::chain {

/// Precondition: the chain is valid (check()).
ChainDrift drift_of(const ChainModel& chain, double rate_hz);

}  // namespace wisp::chain
