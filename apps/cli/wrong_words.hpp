#pragma once
// Suggestions for a command line that the parser rejected.

#include <span>
#include <string>

namespace wisp::cli {

/// Returns one line about the first unknown command or flag, with the nearest known one. Empty if all words are known
/// and something else is wrong.
std::string wrong_words(std::span<const std::string> words);

}  // namespace wisp::cli
