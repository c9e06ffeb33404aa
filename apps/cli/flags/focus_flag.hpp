#pragma once
// The flag that says what coefficients are best at.

#include <string>

#include "command.hpp"
#include "wisp/learn/arx_recipe.hpp"

namespace wisp::cli {

/// --focus; `more` ends its help.
Flag focus_flag(const std::string& more);

ArxFocus focus_of(const Arguments& arguments);

}  // namespace wisp::cli
