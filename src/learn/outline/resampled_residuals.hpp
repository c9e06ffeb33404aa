#pragma once
// Resampled residuals of an outline: recorded shocks are replayed, so that no distribution has to be assumed.
//
// Source: the bootstrap of residuals in blocks (H. R. Künsch, "The jackknife and the bootstrap for general stationary
// observations", Annals of Statistics 17 (1989), section 2.4; for residuals of autoregressions D. A. Freedman, "On
// bootstrapping two-sided confidence intervals in linear models", 1984). Departure: blocks have no fixed length. A
// block lasts as long as input and trend match those of its recording, and the next begins where they match again. So
// the nonlinear and asymmetric part of the response to the input is replayed along with the noise.

#include <span>

#include "learn/outline/outline_dynamics.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"

namespace wisp {

inline constexpr double kLargestStored = 127;  ///< largest 8-bit number of a stored row

/// Nearest whole number of scales, within ±`largest`; 0 where the scale is 0.
double stored(double value, double scale, double largest = kLargestStored);

/// One-step residuals of the prepared recordings under dynamics with a shape, 8 bits per component, prepared for
/// resampling; an input from the other side plays mirror images. Empty where less than a second remains.
/// Errors: as predict().
///
/// Precondition: the dynamics have a shape.
Result<ResampledResiduals> resampled_residuals(const OutlineDynamics& dynamics, std::span<const Recording> recordings,
                                               const PreparedOutlines& prepared);

}  // namespace wisp
