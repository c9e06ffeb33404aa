#pragma once
// A model's rule of extinction in words and figures.

#include "wisp/base/report.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// `extinction` {input, level, seconds, haste, recovery, modes [{name, moves, source, seconds, events, seconds_ci95,
/// error, starts, ends}]}: a thing that goes out is a hybrid automaton of the modes burning, dying, out and catching.
/// `extinction` is none where nothing puts the model out.
ReportSection extinction_section(const Model& model);

}  // namespace wisp
