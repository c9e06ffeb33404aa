#pragma once
// A report as a JSON document, for programs.

#include <string>

#include "wisp/base/report.hpp"

namespace wisp {

/// Returns one JSON object. Ids name its fields, dots nest; an interval stands beside its figure as ID_ci95; a table is
/// a list of objects; the verdict is `usable` {`verdict`, `reason`}, warnings are `warnings`. Numbers that are not
/// finite are null. Series are omitted: they are for pictures.
///
/// Precondition: no id is both a figure and the beginning of another's ("stable" beside "stable.radius").
std::string to_json(const Report& report, int indent = 2);

}  // namespace wisp
