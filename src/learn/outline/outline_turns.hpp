#pragma once
// Cross-validation of an outline that nothing drives: seconds are held out in turn.
//
// A film of a flame is short and rarely alike from end to end: it is calm, then flickers; it leans, then somebody
// blows. Its last third says how a model learned from the rest fares elsewhere; of a model that is learned from all of
// it, as the returned one is, seconds spread over all of it say how it fares.

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "learn/outline/outline_figures.hpp"
#include "learn/outline/outline_preparation.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Estimates a model from prepared recordings, in which what is held out is missing.
using OutlineEstimate = std::function<Result<ArxModel>(std::span<const Recording> recordings)>;

/// Figures of all rows, each predicted by a model that was estimated without it: every `turns`-th second is held out,
/// in turn. A prediction starts from measured rows before it, of whatever turn.
/// Errors: as `estimate`; as outline_figures().
///
/// Precondition: turns >= 2.
Result<OutlineFigures> figures_in_turn(const OutlineEstimate& estimate, const PreparedOutlines& prepared,
                                       std::size_t turns);

}  // namespace wisp
