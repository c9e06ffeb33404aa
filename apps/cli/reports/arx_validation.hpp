#pragma once
// `wisp validate` for models of plain numbers.

#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// Validates a model on a table: fit, J and errors per number of steps, how often the model's own intervals hold, and
/// residual tests; with --figures the plots of them.
/// Errors: the table cannot be read or has not the model's channels; a flag that is only for outlines.
Result<void> validate_plain(const Model& model, const std::vector<int>& steps, const Arguments& arguments,
                            Terminal& terminal);

/// Reads the recording that such a model is validated on, within --range. --inputs and --outputs, if given, name the
/// columns of the model's channels in the model's order; a table without a rate has the model's.
/// Errors: as read_table() and in_range(); another number of names than the model has channels.
Result<Recording> table_for(const Model& model, const std::string& path, const Arguments& arguments);

}  // namespace wisp::cli
