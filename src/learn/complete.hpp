#pragma once
// Final steps of every fit, whatever the kind of model.

#include "wisp/learn/learn.hpp"
#include "wisp/run/cost.hpp"

namespace wisp {

/// Records in the model's training the program's version and the cost of a frame, and adds the cost to the report. A
/// model that cannot be played has no cost.
void complete(Fit& fit);

/// Section `cost` {multiply_adds_per_frame, operations_per_frame, …}.
ReportSection cost_section(const Cost& cost);

}  // namespace wisp
