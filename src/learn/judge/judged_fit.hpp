#pragma once
// The fit of an ARX model, judged by free simulation of the rows that it was fitted to.

#include <span>

#include "learn/fit/arx_fit.hpp"

namespace wisp {

/// Fits an ARX model to all episodes of all recordings together; no history crosses a gap.
/// Returns the model (means, coefficients, standard errors, noise) and its summary. A fit that cannot be trusted is
/// returned with `usable.verdict` false and the reason.
/// Errors: no recordings, a channel missing from a recording, orders of the wrong shape, rates that differ, no more
/// rows than coefficients of an output, delays longer than the data, infinite samples.
Result<ArxFit> fit_arx(std::span<const Recording> recordings, const ChannelChoice& channels, const ArxOptions& options);

}  // namespace wisp
