#pragma once
// Formats the values of a report for text and HTML.

#include <string>

#include "wisp/describe/text.hpp"

namespace wisp {

/// Returns the text followed by its unit, if any.
std::string with_unit(const std::string& text, const std::string& unit);

/// Formats a value without its unit; "diverges" for percentages of a diverging simulation.
std::string shown_in_unit(const ReportValue& value, const std::string& unit);

/// Formats a value with its unit.
std::string shown_with_unit(const ReportValue& value, const std::string& unit);

}  // namespace wisp
