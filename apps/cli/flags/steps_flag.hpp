#pragma once
// How far ahead, and where a free run starts.

#include <string>
#include <vector>

#include "command.hpp"
#include "wisp/learn/arx_recipe.hpp"

namespace wisp::cli {

/// A number of steps ahead, or `inf` for kFreeRun. Errors: it is neither.
Result<int> steps_of(const std::string& word);

/// All of --steps. Errors: one of them is neither.
Result<std::vector<int>> steps_in(const Arguments& arguments);

Flag initial_flag();
InitialState initial_of(const Arguments& arguments);

}  // namespace wisp::cli
