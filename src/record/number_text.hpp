#pragma once
// Numbers as text, the same in every country: a host's setlocale() may make printf write a decimal comma, which no
// reader of a file or a message expects.

#include <string>

namespace wisp {

/// The shortest text that reads back as the same double.
std::string number_text(double value);

/// At most so many significant digits (1 to 17), as printf's %g writes them.
std::string number_text(double value, int digits);

}  // namespace wisp
