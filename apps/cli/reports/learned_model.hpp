#pragma once
// How the commands hand over what they learned.

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

/// Where the model is to be written; empty: nowhere. And what it is called then.
std::string model_path(const Arguments& arguments);
std::string model_name(const Arguments& arguments);

/// Whether a file of that name, where there is one, can be written: asked before work that takes long. Errors: as
/// write_file().
Result<void> check_writable(const std::string& path);

/// Shows the report and writes the model where `path` is not empty, with where and how long since `start` it took.
/// Errors: as write_model().
Result<void> hand_over(const Fit& fit, const std::string& path, std::chrono::steady_clock::time_point start,
                       Terminal& terminal);

}  // namespace wisp::cli
