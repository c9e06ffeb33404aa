#pragma once
// Segment chains: learned from recordings of something that moves, and judged on others.

#include <cstdint>
#include <span>

#include "wisp/base/progress.hpp"
#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/chain_recipe.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Learns a chain, with its response to gusts where two of the recordings are a pair, and judges it on the stretches
/// that were held out (where none are, on those that it was learned from).
/// Errors, each with the file that it is about: as check_motion(); a pair that is none; no falls beside it; no event,
/// or fewer segments than modes; a recipe out of range; stopped by `progress`.
Result<Fit> learn_chain(std::span<const Recording> recordings, const ChainRecipe& recipe,
                        const Progress& progress = {});

/// Compares falls that the model makes with recorded ones, which it should not have seen; or, given a windy recording
/// and its calm twin, what gusts do to it. The report's series are the tracks of both.
/// Errors: as check_motion(); the model is no chain, or does not say how its motion was cut; rates that differ; a pair
/// that is none; stopped by `progress`.
Result<Report> validate_chain(const Model& model, std::span<const Recording> recordings, std::uint64_t seed,
                              const Progress& progress = {});

}  // namespace wisp
