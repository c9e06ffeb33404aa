#pragma once
// Description of a model in figures, from the model alone without recordings.

#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"

namespace wisp {

/// Returns name, rate_hz, inputs [{name, unit, range, shape}], outputs [{name, unit, range}]; dynamics {kind,
/// …}, for an ARX model with coefficients, poles, zeros and static gains, for a switched one with its modes and their
/// switching, for a chain with its transitions; view {kind, …}, cost, made {program, sources, options, figures},
/// extinction {input, level, seconds, haste, recovery, modes [{name, source, seconds, events}]}, with the modes dying
/// (decay) and catching (re-ignition), null if the model has no rule. The verdict is that of the training.
/// Errors: the model cannot be played.
Result<Report> model_report(const Model& model);

/// Returns the remaining content of a model's file, for programs, under ids that model_report() does not use: both
/// reports suffice to rewrite the model, or to play it in another language. docs/reference/model-file.md documents the
/// fields and bit-exact playback.
Report model_contents(const Model& model);

}  // namespace wisp
