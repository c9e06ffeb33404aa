#pragma once
// `wisp validate` for segment chains.

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/model/model.hpp"

namespace wisp::cli {

/// Shows how a chain's falls compare with recorded ones, or its response with that of a pair, and draws both.
/// Errors: the recording can't be read or compared, a flag that only outlines have.
Result<void> validate_chain(const Model& model, const Arguments& arguments, Terminal& terminal);

}  // namespace wisp::cli
