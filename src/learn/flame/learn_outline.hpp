#pragma once
// From recordings of an outline to its model.

#include <span>

#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/learn/outline_recipe.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Learns a model of an outline from recordings in pixels: puts their inputs on a common scale where that is better,
/// leaves extinctions out of what the dynamics are learned from, and learns the rule of extinction from them. The model
/// has the knots of the first recording; recordings with others are expressed in those, with a warning.
/// The report has rate_hz, inputs, points, na, nb, nk, order_and_delay, alignment, samples, channels, J,
/// tip, overlap, fpe, stable, held_share, cost, gain, extinction, and the verdict.
/// Errors, naming the recording: none, not an outline, another number of points than the first, rates that differ,
/// inputs that it has not, too few rows for the order, a recipe out of range; kStopped.
Result<Fit> learn_outline(std::span<const Recording> recordings, const OutlineRecipe& recipe,
                          const Progress& progress = {});

}  // namespace wisp
