#pragma once
// What a command would write, looked at before it does any work.

#include "command.hpp"
#include "wisp/base/result.hpp"

namespace wisp::cli {

/// Errors: an output, or what it brings with it, is a file that the command reads; or its name is of another kind of
/// file than what is written.
Result<void> check_outputs(const Command& command, const Arguments& arguments);

}  // namespace wisp::cli
