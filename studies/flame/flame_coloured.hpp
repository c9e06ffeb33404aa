#pragma once
// A flame whose residuals are coloured: ARARX and ARMAX for every control point.

#include <span>

#include "wisp/base/result.hpp"
#include "wisp/learn/coloured_arx.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::verify {

/// A flame with coloured noise.
struct ColouredFlame {
  Model model;                ///< as ARX with a white residual, each channel's noise its own
  double log_likelihood = 0;  ///< of a held-out row, all channels together, nats
};

/// Learns what fit_outline() learns at order 4 with points coupled and independent noise, but with a noise filter a
/// channel, from the first 70 % of every clip for the likelihood and from everything for the model.
/// Errors: as fit_outline() and fit_coloured_arx().
Result<ColouredFlame> learn_coloured_flame(std::span<const Recording> clips, const NoiseModel& noise);

}  // namespace wisp::verify
