#pragma once
// A report as plain text, for people.

#include <iosfwd>
#include <string>

#include "wisp/base/report.hpp"

namespace wisp {

/// The verdict first, then warnings, then each section: labelled figures, one a line, with unit, interval and meaning,
/// and tables with aligned columns. What has no label is left out. Ends with a new line unless the report is empty.
std::string to_text(const Report& report);

/// The same.
std::ostream& operator<<(std::ostream& out, const Report& report);

/// A value as reports show it: numbers with `digits` significant digits, "none" for what is not finite or not there,
/// lists separated by commas.
std::string shown(const ReportValue& value, int digits = 4);

}  // namespace wisp
