#pragma once
// `wisp validate` for models whose outputs stand for themselves.

#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// Holds a model against a table: fit, J and errors per number of steps, how often the model's own intervals hold, and
/// residual tests; with --figures the plots of them.
/// Errors: the table cannot be read or has not the model's channels; a flag that is only for outlines.
Result<void> validate_plain(const Model& model, const std::vector<int>& steps, const Arguments& arguments,
                            Terminal& terminal);

/// The recording that such a model is judged on, its --range. Where --inputs or --outputs are given they name, in the
/// model's order, the columns that stand for its channels; a table that states no rate has the model's.
/// Errors: as read_table() and in_range(); another number of names than the model has channels.
Result<Recording> table_for(const Model& model, const std::string& path, const Arguments& arguments);

}  // namespace wisp::cli
