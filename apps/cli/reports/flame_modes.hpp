#pragma once
// A flame that goes out as a hybrid automaton: its modes, what leads from one to the next, and what each starts from.

#include <optional>
#include <string>
#include <vector>

#include "terminal.hpp"
#include "wisp/learn/extinction.hpp"
#include "wisp/learn/flame_sizes.hpp"
#include "wisp/model/model.hpp"

namespace wisp::cli {

/// What recordings tell of dying and catching; a mode that none of them shows is absent.
struct LearnedRamps {
  std::optional<RampFit> dying;
  std::optional<RampFit> catching;
};

/// Errors: as flame_sizes().
Result<LearnedRamps> learn_ramps(std::span<const ExtinctionEvidence> evidence);

/// Gives the model's rule its durations, and its provenance what they were learned from.
///
/// Precondition: the model has a rule of extinction.
void set_ramps(const LearnedRamps& ramps, Model& model);

/// `modes` [{name, moves, source, seconds, events, seconds_ci95, error, starts, ends}] of a model that goes out:
/// burning, dying, out, catching.
///
/// Precondition: the model has a rule of extinction.
Json modes_of(const Model& model);

/// The same for people, a line a mode.
std::vector<std::string> mode_lines(const Model& model);

/// How far a model's dying and catching are from a recording's sizes, beside the defaults': `dying` and `catching`,
/// each {events, error, default_error}. Errors: as flame_sizes().
Result<Json> judged_ramps(const Extinction& rule, const ExtinctionEvidence& evidence);

}  // namespace wisp::cli
