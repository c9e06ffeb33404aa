#pragma once
// What every fit ends with, whichever room made it.

#include "wisp/learn/learn.hpp"
#include "wisp/run/cost.hpp"

namespace wisp {

/// Says in the model's training which program learned it and what a frame costs, and the cost in the report. A model
/// that cannot be played costs nothing.
void complete(Fit& fit);

/// `cost` {multiply_adds_per_frame, operations_per_frame, …}.
ReportSection cost_section(const Cost& cost);

}  // namespace wisp
