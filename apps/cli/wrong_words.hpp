#pragma once
// What a command line that the parser refused was probably meant to be.

#include <span>
#include <string>

namespace wisp::cli {

/// One line about the first word (after the program's name) that is no command or no flag of its command, with the
/// nearest that there is. Empty: all words are known, and something else is wrong.
std::string wrong_words(std::span<const std::string> words);

}  // namespace wisp::cli
