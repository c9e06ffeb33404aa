#pragma once
// The flag that says what coefficients are best at.

#include <string>

#include "command.hpp"
#include "wisp/learn/arx_recipe.hpp"

namespace wisp::cli {

/// --focus.
Flag focus_flag();

ArxFocus focus_of(const Arguments& arguments);

}  // namespace wisp::cli
