#pragma once
// Resampled residuals of an outline: recorded residuals are replayed as shocks, so no distribution has to be assumed.
//
// Source: the bootstrap of residuals in blocks (H. R. Künsch, "The jackknife and the bootstrap for general stationary
// observations", Annals of Statistics 17 (1989), section 2.4; for residuals of autoregressions D. A. Freedman, "On
// bootstrapping two-sided confidence intervals in linear models", 1984). Departure: blocks have no fixed length.
// With an input, a block ends when the input history recorded at another row is nearer to the present one by more than
// a tolerance, or after 1.5 s. So the nonlinear and asymmetric part of the response is replayed along with the noise.

#include <span>

#include "learn/outline/outline_dynamics.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"

namespace wisp {

inline constexpr double kLargestStored = 127;  ///< largest 8-bit number that stores a residual

/// Returns value / scale, rounded and clamped to ±`largest`; 0 if the scale is 0.
double stored(double value, double scale, double largest = kLargestStored);

/// Returns the one-step residuals of the prepared recordings for resampling, 8 bits per shape component. Usable rows
/// are complete, with their input's past and an outline that does not intersect itself. With inputs and less than a
/// second of usable rows the result is empty. Input of the opposite sign replays rows mirrored. Errors: as predict();
/// no two consecutive usable rows. Precondition: the dynamics have a shape.
Result<ResampledResiduals> resampled_residuals(const OutlineDynamics& dynamics, std::span<const Recording> recordings,
                                               const PreparedOutlines& prepared);

}  // namespace wisp
