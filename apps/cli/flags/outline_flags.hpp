#pragma once
// Flags of learning an outline: from flags to a recipe.

#include <string>
#include <vector>

#include "command.hpp"
#include "wisp/learn/outline_recipe.hpp"

namespace wisp::cli {

/// Flags of learning an outline, beside those of capturing it, `--blow-out` and `--input-curve`.
std::vector<Flag> outline_flags();

/// `--blow-out`; `fallback` is its default: auto for flames, off for what does not burn.
Flag extinction_flag(const std::string& fallback);

/// --align, which learning and validating share.
Flag align_flag();

/// Errors: a value out of its range.
Result<OutlineRecipe> outline_recipe(const Arguments& arguments, std::string name);

}  // namespace wisp::cli
