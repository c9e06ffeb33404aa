#pragma once
// Numbers as text, the same in every country: a host's setlocale() may make printf write a decimal comma, which no
// reader of a file or a message expects.

#include <charconv>
#include <string>

namespace wisp {

/// The shortest text that reads back as the same double.
std::string number_text(double value);

/// At most so many significant digits (1 to 17), as printf's %g writes them.
std::string number_text(double value, int digits);

/// As std::from_chars, which macOS's and Emscripten's C++ library have of whole numbers alone.
std::from_chars_result read_number(const char* first, const char* last, double& value);

}  // namespace wisp
