#pragma once
// What every fit ends with, whichever room made it.

#include "wisp/learn/fit.hpp"

namespace wisp {

/// Says in the model's training which program learned it and what a frame costs, and the cost in the report. A model
/// that cannot be played costs nothing.
void complete(Fit& fit);

}  // namespace wisp
