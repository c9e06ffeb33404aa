#pragma once
// --na, --nb, --nk and --coupling as recipes have them.

#include <algorithm>
#include <initializer_list>

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

/// What a flag's word stands for, `words` being in the enumeration's order.
template <class Choice>
Choice choice_of(const Arguments& arguments, const char* flag, std::initializer_list<std::string_view> words) {
  return static_cast<Choice>(std::find(words.begin(), words.end(), arguments.text(flag)) - words.begin());
}

/// --coupling.
Coupling coupling_of(const Arguments& arguments);

}  // namespace wisp::cli
