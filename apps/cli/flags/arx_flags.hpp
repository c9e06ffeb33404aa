#pragma once
// Flags --na, --nb, --nk, --steps and --initial, and their values.

#include <string>
#include <vector>

#include "command.hpp"
#include "wisp/learn/arx_recipe.hpp"

namespace wisp::cli {

struct OrderHelp {
  const char* fallback;    ///< default of --na and --nb
  const char* of_a = "";   ///< appended to "order of A" in the help of --na
  const char* delay = "";  ///< appended to the help of --nk: further values
};

/// Returns the flags --na, --nb and --nk.
std::vector<Flag> order_flags(const OrderHelp& help);

/// Parses --na, --nb or --nk: a number for all pairs of channels, or a matrix such as '4,2;3,4' (rows separated by
/// semicolons) with a row for each of --outputs and a column for each of --outputs (--na) or --inputs.
/// Errors: text that cannot be parsed or has another shape, with what was found and expected.
Result<OrderChoice> order_choice(const Arguments& arguments, const std::string& flag);

/// Parses the values of --steps: numbers of steps ahead, 1 to 100000, or `inf` for kFreeRun. Errors: any other value.
Result<std::vector<int>> steps_in(const Arguments& arguments);

Flag initial_flag();

}  // namespace wisp::cli
