#pragma once
// `wisp learn arx --search`: the grid and the criterion.

#include <vector>

#include "command.hpp"
#include "wisp/learn/arx_recipe.hpp"

namespace wisp::cli {

/// --search, --by, --validate, --per-output, --steps.
std::vector<Flag> search_flags();

/// The search that they ask for. `whole` are the recordings before --range was taken, from which --validate takes its
/// rows. Errors: a grid that cannot be understood, validation without --validate, a range beyond a recording.
///
/// Precondition: --search is given.
Result<ArxSearch> search_of(const std::vector<Recording>& whole, const Arguments& arguments);

}  // namespace wisp::cli
