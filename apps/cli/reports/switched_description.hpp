#pragma once
// A switched ARX model in words and JSON.

#include "terminal.hpp"
#include "wisp/model/switched.hpp"

namespace wisp::cli {

/// Sets `modes` [{A, B, std_error, constant, shock, radius}], `regions` or `initial` and `transitions`, `lyapunov`
/// (whether there is a common Lyapunov function) and `bounded_by`, a sentence.
void describe_switched(const SwitchedArxModel& model, Json& result);

}  // namespace wisp::cli
