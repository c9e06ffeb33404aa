#pragma once
// `wisp validate` for segment chains.

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/model/model.hpp"

namespace wisp::cli {

/// Holds a chain against recorded falls: likeness, jumps at joins, figures. The event is the one that the chain was
/// learned with.
/// Errors: the recording can't be read or compared, a flag that only outlines have.
Result<void> validate_chain(const Model& model, const Arguments& arguments, Terminal& terminal);

}  // namespace wisp::cli
