#pragma once
// A report as a piece of an HTML page, for people.

#include <string>
#include <string_view>

#include "wisp/base/report.hpp"

namespace wisp {

/// What to_text() says, as elements without style: the verdict as a paragraph of class `verdict` and `usable` or
/// `refused`, warnings as a list, each section under a heading of the third rank with one table of its figures (label,
/// value with unit and interval, meaning) and its tables. Text is escaped.
std::string to_html(const Report& report);

/// Text as it stands in an element or in a quoted attribute.
std::string html_escaped(std::string_view text);

}  // namespace wisp
