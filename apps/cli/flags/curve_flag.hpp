#pragma once
// `--input-curve`: how many knots the curves on a model's inputs have.

#include <optional>
#include <string>

#include "command.hpp"

namespace wisp::cli {

/// The flag, and what it is where nothing is said; `help` ends its help.
Flag curve_flag(const std::string& unless_said, const std::string& help);

/// Knots as the flag says: 0 none, unset where held-out rows are to say.
std::optional<int> curve_knots_of(const Arguments& arguments);

}  // namespace wisp::cli
