#pragma once
// `wisp validate` for switched models.

#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/model/model.hpp"

namespace wisp::cli {

/// Holds a switched model against a table: fit, J and errors per number of steps, the likelihood and how often each
/// mode acts. Errors: the table cannot be read or has not the model's channels; a flag that is for other models.
Result<void> validate_switched(const Model& model, const std::vector<int>& steps, const Arguments& arguments,
                               Terminal& terminal);

}  // namespace wisp::cli
