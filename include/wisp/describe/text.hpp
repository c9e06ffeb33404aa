#pragma once
// A report for people, as plain text or as an HTML fragment.

#include <iosfwd>
#include <string>
#include <string_view>

#include "wisp/base/report.hpp"

namespace wisp {

/// Returns verdict, warnings and each section: figures, one per line, with unit, interval, meaning; tables with aligned
/// columns. Unlabelled entries are omitted, percentages below −1000 are "diverges". Ends with a new line unless empty.
std::string to_text(const Report& report);

/// Writes to_text(report).
std::ostream& operator<<(std::ostream& out, const Report& report);

/// Returns the content of to_text() as unstyled HTML elements: the verdict as a paragraph of class `verdict` and
/// `usable` or `refused`, warnings as a list, each section under an <h3> with one table of its figures (label, value
/// with unit and interval, meaning) and its tables. Text is escaped.
std::string to_html(const Report& report);

/// Returns text escaped for an HTML element or a quoted attribute.
std::string html_escaped(std::string_view text);

/// Formats a value: numbers with `digits` significant digits, integers in full, "yes" or "no", "none" for missing
/// values and numbers that are not finite, lists separated by commas.
std::string shown(const ReportValue& value, int digits = 4);

}  // namespace wisp
