#pragma once
// `wisp validate` for segment chains.

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/model/model.hpp"

namespace wisp::cli {

/// Compares a chain's falls with recorded ones, or its response to gusts with that of a pair of recordings, and draws
/// both. Errors: the recording can't be read or compared, a flag that only outlines have.
Result<void> validate_chain(const Model& model, const Arguments& arguments, Terminal& terminal);

}  // namespace wisp::cli
