#pragma once
// Free simulation of an ARX model along a recording's inputs.

#include <cstddef>
#include <vector>

#include "arx_rows.hpp"
#include "wisp/learn/prediction.hpp"

namespace wisp {

/// Simulated deviations of all outputs, [output][row], NaN where there are none. Every episode starts anew, and so does
/// every stretch after a gap in the inputs.
std::vector<std::vector<double>> free_run(const ArxModel& model, const Signals& signals, std::size_t recording,
                                          InitialState initial);

}  // namespace wisp
