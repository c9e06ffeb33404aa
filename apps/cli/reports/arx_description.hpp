#pragma once
// What an ARX model is, in figures that stand in every result that shows one.

#include "terminal.hpp"
#include "wisp/model/arx.hpp"

namespace wisp::cli {

/// Adds `A`, `B`, `std_error`, `poles`, `zeros` [output][input] (each a list of [real, imaginary] in the z plane) and
/// `static_gain` [output][input] to a result. Poles are left out (null) where the companion matrix has more than 256
/// rows, and so are zeros where they would be many.
void describe_arx(const ArxModel& model, Json& result);

/// Lines for people: poles as time constants and as resonances with their damping. Nothing for models of many poles.
void say_poles(const ArxModel& model, double rate_hz, Terminal& terminal);

}  // namespace wisp::cli
