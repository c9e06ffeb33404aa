#pragma once
// Output of the commands that learn.

#include <string>
#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/learn.hpp"

namespace wisp::cli {

/// Returns the flag -o of a command that learns: required unless one of these flags or --json is given.
Flag output_flag(std::vector<std::string> unless = {});

/// Return the model's path, empty if no model is written, and the model's name, the stem of the path.
std::string model_path(const Arguments& arguments);
std::string model_name(const Arguments& arguments);

/// Checks before long work that a file of that name can be written; an empty name is accepted. Errors: as write_file().
Result<void> check_writable(const std::string& path);

/// Shows the report, and writes the model if model_path() is not empty. Reports the path and the time since the command
/// began. Errors: that of the fit; as write_model().
Result<void> hand_over(const Result<Fit>& fit, const Arguments& arguments, Terminal& terminal);

}  // namespace wisp::cli
