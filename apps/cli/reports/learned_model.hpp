#pragma once
// Output of the commands that learn.

#include <chrono>
#include <string>
#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/learn.hpp"

namespace wisp::cli {

/// `-o` of a command that learns: required unless one of these flags or --json is given.
Flag output_flag(std::vector<std::string> unless = {});

/// Path of the model (empty: none) and name of the model.
std::string model_path(const Arguments& arguments);
std::string model_name(const Arguments& arguments);

/// Checks before long work that a file of that name can be written; an empty name is accepted. Errors: as write_file().
Result<void> check_writable(const std::string& path);

/// Shows the report, and writes the model if `path` is not empty. Reports the path and the time since `start`.
/// Errors: as write_model().
Result<void> hand_over(const Fit& fit, const std::string& path, std::chrono::steady_clock::time_point start,
                       Terminal& terminal);

}  // namespace wisp::cli
