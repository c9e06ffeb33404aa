#pragma once
// Learns switched dynamics that a lamp can play from the brightness of a flame.

#include <span>

#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/learn.hpp"

namespace wisp {

/// Learns a switched model of a light, with the mean brightness as 1. Errors: a missing channel, different rates, a
/// mean that is not above 0, settings out of range, fewer than 20 s, a mode with too few rows (as in a constant trace),
/// kStopped. Precondition: at least one recording.
Result<Fit> learn_flicker(std::span<const Recording> recordings, const FlickerRecipe& recipe,
                          const Progress& progress = {});

}  // namespace wisp
