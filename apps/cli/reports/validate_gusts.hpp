#pragma once
// `wisp validate` for a chain's response to gusts.

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// Holds a chain that is blown at against a windy recording and its calm twin: the second recording that was given, or
/// REC.calm.csv beside REC.csv. Which of the two is calm is seen from their wind.
/// Errors: there is no twin, or it is none; as play_gusts(); a figure cannot be written.
Result<void> validate_gusts(const Model& model, Recording recording, const Arguments& arguments, Terminal& terminal);

}  // namespace wisp::cli
