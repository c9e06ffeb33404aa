#pragma once
// What a model is, as figures: nothing that needs a recording.

#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// name, rate_hz, inputs [{name, unit, range, shape, curve}], outputs [{name, unit, range}]; dynamics {kind, …}, of an
/// ARX model with its coefficients, poles, zeros and static gains, of a switched one with its modes and what decides
/// between them, of a chain with its transitions; view {kind, …}, cost, made {program, sources, options, figures},
/// extinction {input, level, seconds, haste, recovery, modes [{name, moves, source, seconds, events, seconds_ci95,
/// error, starts, ends}]}, none where nothing puts the model out. A thing that goes out is a hybrid automaton of the
/// modes burning, dying, out and catching (decay, extinguished, re-ignition). The verdict is that of the training.
/// Errors: the model cannot be played.
Result<Report> model_report(const Model& model);

/// All else that a model's file holds, for programs, under ids that model_report() does not use: with both, a model can
/// be written again, or played, in another language. docs/reference/model-file.md has the fields and how they are
/// played, to the bit.
Report model_contents(const Model& model);

}  // namespace wisp
