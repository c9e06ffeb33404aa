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

#include "learn/outline/outline_preparation.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"

namespace wisp {

/// How residuals are kept.
struct ResamplingOptions {
  std::size_t max_bytes = 256 * 1024;  ///< of rows; of longer recordings the first part of each is kept
  bool mirror = false;                 ///< signed inputs: the other side plays mirror images
};

/// What `model` leaves of the prepared recordings one step ahead, ready to be resampled; empty where nothing is left
/// that could be (less than a second). Errors: as predict().
Result<ResampledResiduals> resampled_residuals(const ArxModel& model, std::span<const Recording> recordings,
                                               const PreparedOutlines& prepared, const ResamplingOptions& options);

/// The same dynamics about the operating point where all inputs are 0: inputs' means are 0 then, and a regressor that
/// is 0 adds nothing.
///
/// Precondition: the model is stable.
void centre_on_calm(ArxModel& model);

}  // namespace wisp
