#pragma once
// `learn arx --noise-model`: ARARX and ARMAX, as the ARX model with a white residual that is played.

#include <span>

#include "terminal.hpp"
#include "wisp/learn/arx_fit.hpp"
#include "wisp/learn/coloured_arx.hpp"

namespace wisp::cli {

/// Fits, says what the noise filter is, and returns the model to play with the figures that it has on its recordings.
/// Errors: as fit_coloured_arx() and prediction_figures().
Result<ArxFit> fit_coloured(std::span<const Recording> recordings, const ChannelChoice& channels,
                            const ColouredArxOptions& options, Terminal& terminal);

}  // namespace wisp::cli
