#pragma once
// From the brightness of a flame to switched dynamics that a lamp can play.

#include <span>

#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/learn.hpp"

namespace wisp {

/// Errors: no recordings, a channel that they have not, light that is not above 0 on average, settings out of range,
/// fewer than 20 s, a trace that never changes, kStopped.
Result<Fit> learn_flicker(std::span<const Recording> recordings, const FlickerRecipe& recipe,
                          const Progress& progress = {});

}  // namespace wisp
