#pragma once
// Checks a command's outputs before any work.

#include "command.hpp"
#include "wisp/base/result.hpp"

namespace wisp::cli {

/// Errors: an output or one of its further files is also an input, or its extension is of another kind of file.
Result<void> check_outputs(const Command& command, const Arguments& arguments);

}  // namespace wisp::cli
