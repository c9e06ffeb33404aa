#pragma once
// Learns the model of an outline from recordings.

#include <span>

#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/learn/outline_recipe.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Learns a model of an outline from recordings in pixels: scales their inputs to a common gain, excludes extinctions
/// from the dynamics, and learns the extinction rule from them. The model has the first recording's knots; recordings
/// with other knots are converted, with a warning.
/// The report has rate_hz, inputs, points, samples, alignment, na, nb, nk, components, ridge, noise, tip, overlap, J,
/// stable, spread, outside_share, crossed_share, held_share, play, gain, extinction, and the verdict.
/// Errors, naming the recording: no recordings, not an outline, a different number of points, rates that differ,
/// missing inputs, too few rows for the order, a recipe out of range; kStopped.
Result<Fit> learn_outline(std::span<const Recording> recordings, const OutlineRecipe& recipe,
                          const Progress& progress = {});

}  // namespace wisp
