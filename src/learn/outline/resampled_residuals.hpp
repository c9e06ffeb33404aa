#pragma once
// Residuals of an outline as they were, to be played again: the shocks that no distribution has to be found for.
//
// Source: the bootstrap of residuals in blocks (H. R. Künsch, "The jackknife and the bootstrap for general stationary
// observations", Annals of Statistics 17 (1989), section 2.4; for residuals of autoregressions D. A. Freedman, "On
// bootstrapping two-sided confidence intervals in linear models", 1984). Departure: a block has no fixed length; it
// goes on for as long as the input and its trend are what they were when it was recorded, and the next one is chosen
// where they were. So what a linear answer to the input leaves, its bend and its asymmetry, is played back with the
// noise.

#include <span>

#include "learn/outline/outline_dynamics.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"

namespace wisp {

/// What dynamics of a shape leave of the prepared recordings one step ahead, in 8 bits a component, ready to be
/// resampled: an input from the other side plays mirror images. Empty where less than a second is left.
/// Errors: as predict().
///
/// Precondition: the dynamics have a shape.
Result<ResampledResiduals> resampled_residuals(const OutlineDynamics& dynamics, std::span<const Recording> recordings,
                                               const PreparedOutlines& prepared);

}  // namespace wisp
