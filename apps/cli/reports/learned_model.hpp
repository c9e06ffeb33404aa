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

/// The path of the model, empty for none, and the model's name.
std::string model_path(const Arguments& arguments);
std::string model_name(const Arguments& arguments);

/// Checks that a file of that name can be written, before long work; an empty name is fine. Errors: as write_file().
Result<void> check_writable(const std::string& path);

/// Shows the report, and writes the model if `path` is not empty. Reports the path and the time since `start`.
/// Errors: as write_model().
Result<void> hand_over(const Fit& fit, const std::string& path, std::chrono::steady_clock::time_point start,
                       Terminal& terminal);

}  // namespace wisp::cli
