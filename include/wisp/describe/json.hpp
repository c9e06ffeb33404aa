#pragma once
// A report as a JSON document, for programs.

#include <string>

#include "wisp/base/report.hpp"

namespace wisp {

/// Returns one JSON object. Ids name its fields, dots nest; an interval stands beside its figure as ID_ci95; a table is
/// a list of objects; the verdict is `usable` {`verdict`, `reason`, `code` if there is one}, warnings are `warnings`.
/// Numbers that are not finite are null. Series, and entries and tables without an id, are omitted.
/// Precondition: no id of a figure is the beginning of another id ("stable" beside "stable.radius").
std::string to_json(const Report& report, int indent = 2);

}  // namespace wisp
