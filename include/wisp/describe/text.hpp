#pragma once
// A report for people: as plain text, or as a piece of an HTML page.

#include <iosfwd>
#include <string>
#include <string_view>

#include "wisp/base/report.hpp"

namespace wisp {

/// The verdict first, then warnings, then each section: labelled figures, one a line, with unit, interval and meaning,
/// and tables with aligned columns. What has no label is left out. Ends with a new line unless the report is empty.
std::string to_text(const Report& report);

/// The same.
std::ostream& operator<<(std::ostream& out, const Report& report);

/// What to_text() says, as elements without style: the verdict as a paragraph of class `verdict` and `usable` or
/// `refused`, warnings as a list, each section under a heading of the third rank with one table of its figures (label,
/// value with unit and interval, meaning) and its tables. Text is escaped.
std::string to_html(const Report& report);

/// Text as it stands in an element or in a quoted attribute.
std::string html_escaped(std::string_view text);

/// A value as reports show it: numbers with `digits` significant digits, "none" for what is not finite or not there,
/// lists separated by commas.
std::string shown(const ReportValue& value, int digits = 4);

}  // namespace wisp
