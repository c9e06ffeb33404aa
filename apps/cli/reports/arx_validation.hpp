#pragma once
// `wisp validate` for models whose outputs are plain channels.

#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// Validates a model on a table: fit, J and errors per number of steps, coverage of the model's own intervals, and
/// residual tests; with --figures also their plots.
/// Errors: the table cannot be read or lacks the model's channels; a flag for outlines only.
Result<void> validate_plain(const Model& model, const std::vector<int>& steps, const Arguments& arguments,
                            Terminal& terminal);

/// Reads the recording for validating such a model, within --range. --inputs and --outputs, if given, name the columns
/// of the model's channels in the model's order; a table without a rate takes the model's.
/// Errors: as read_table() and in_range(); a number of names other than the model's number of channels.
Result<Recording> table_for(const Model& model, const std::string& path, const Arguments& arguments);

}  // namespace wisp::cli
