#pragma once
// What an ARX model is, in figures.

#include "wisp/base/report.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/model/model.hpp"

namespace wisp::arx {

/// For programs `A`, `B`, `std_error`, `poles`, `zeros` [output][input] (lists of [real, imaginary] in the z plane) and
/// `static_gain` [output][input], their ids after `prefix`. Poles are null where the companion matrix has more than
/// 256 rows, and zeros where it has more than 48.
void describe(const ArxModel& model, const std::string& prefix, ReportSection& section);

/// For people: a section an output with its coefficients and their standard errors, and one of the poles as time
/// constants and as resonances with their damping; nothing where they are many.
void tell(const ArxModel& model, const Model& of, Report& report);

/// For people: the poles alone.
void tell_poles(const ArxModel& model, double rate_hz, Report& report);

}  // namespace wisp::arx
