#pragma once
// How the commands hand over what they learned.

#include <chrono>
#include <string>

#include "terminal.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/learn.hpp"

namespace wisp::cli {

/// Whether a file of that name can be written: asked before work that takes long. Errors: as write_file().
Result<void> check_writable(const std::string& path);

/// Shows the report and writes the model, with where and how long since `start` it took. Errors: as write_model().
Result<void> hand_over(const Fit& fit, const std::string& path, std::chrono::steady_clock::time_point start,
                       Terminal& terminal);

}  // namespace wisp::cli
