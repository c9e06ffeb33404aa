#pragma once
// Numbers as text, in every locale alike: a host's setlocale() may make printf write a decimal comma, which no reader
// of a file or a message expects.

#include <charconv>
#include <string>

namespace wisp {

/// Returns the shortest text that reads back as the same double.
std::string number_text(double value);

/// Formats a number with at most `digits` significant digits (1 to 17), like printf's %g.
std::string number_text(double value, int digits);

/// Like std::from_chars, which macOS's and Emscripten's C++ libraries implement for integers only.
std::from_chars_result read_number(const char* first, const char* last, double& value);

}  // namespace wisp
