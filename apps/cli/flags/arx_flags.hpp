#pragma once
// --na, --nb and --nk as recipes have them; how far ahead is predicted, and where a free run starts.

#include <string>
#include <vector>

#include "command.hpp"
#include "wisp/learn/arx_recipe.hpp"

namespace wisp::cli {

/// What their help says besides.
struct OrderHelp {
  const char* fallback;    ///< of --na and --nb
  const char* of_a = "";   ///< what A belongs to
  const char* delay = "";  ///< what --nk may be besides
};

/// The flags.
std::vector<Flag> order_flags(const OrderHelp& help);

/// What --na, --nb or --nk says: a number for all pairs of channels, or a matrix, '4,2;3,4' (rows by semicolons), of a
/// row for each of --outputs and a column for each of --outputs (--na) or --inputs.
/// Errors: text that cannot be understood or has not that shape, with what was found and expected.
Result<OrderChoice> order_choice(const Arguments& arguments, const std::string& flag);

/// All of --steps: numbers of steps ahead, or `inf` for kFreeRun. Errors: one is neither.
Result<std::vector<int>> steps_in(const Arguments& arguments);

Flag initial_flag();

}  // namespace wisp::cli
