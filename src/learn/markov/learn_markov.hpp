#pragma once
// Learns a Markov-switched model and its report from recordings and a recipe, and validates a model on a recording.

#include <span>

#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/arx_recipe.hpp"
#include "wisp/learn/learn.hpp"
#include "wisp/learn/validate.hpp"

namespace wisp {

/// Learns a switched model. Errors: no recordings, missing channels, settings out of range, too few rows, kStopped.
Result<Fit> learn_switched(std::span<const Recording> recordings, const SwitchedRecipe& recipe,
                           const Progress& progress = {});

/// Reports predictions, free simulation, likelihood, and the number of rows in which each mode acts.
/// Errors: the recording does not have the model's channels or is too short, steps out of range, kStopped.
///
/// Precondition: the model's dynamics are a SwitchedArxModel.
Result<Report> validate_switched(const Model& model, const Recording& recording, const ValidationOptions& options = {},
                                 const Progress& progress = {});

namespace markov {

/// Adds figures for programs, whose ids begin with `prefix`: `modes` [{A, B, constant, shock, radius, std_error}],
/// `initial` and `transitions`.
void describe(const SwitchedArxModel& model, const std::string& prefix, ReportSection& section);

}  // namespace markov
}  // namespace wisp
