#pragma once
// Values of a report as people read them, in text and on a page.

#include <string>

#include "wisp/describe/text.hpp"

namespace wisp {

/// The text with its unit behind it, where there is one.
std::string with_unit(const std::string& text, const std::string& unit);

/// A value of that unit, without it: "diverges" for percentages of a simulation that runs away, whose digits say
/// nothing more.
std::string shown_in_unit(const ReportValue& value, const std::string& unit);

/// The same with its unit.
std::string shown_with_unit(const ReportValue& value, const std::string& unit);

}  // namespace wisp
