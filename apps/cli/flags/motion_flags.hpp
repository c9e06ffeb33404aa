#pragma once
// Flags that name the columns of position and orientation in a recording of motion.

#include <string>
#include <vector>

#include "command.hpp"
#include "wisp/record/csv.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

std::vector<Flag> motion_flags();

/// Returns the columns that --position names, then those that --orientation names; none for a flag that is not given.
/// Errors: --position does not name three columns, --orientation does not name four.
Result<std::vector<std::string>> motion_columns(const Arguments& arguments);

/// Returns options for reading a plain table of motion. Columns with the names that learning expects need no flags.
/// `rate_hz` is used if neither flag nor table states the rate. A time column is kept, so that uneven time is detected.
CsvOptions motion_table(const Arguments& arguments, double rate_hz = 0);

/// Renames a recording's columns as learning expects: pos.x, pos.y, pos.z, q.w, q.x, q.y, q.z; without either flag,
/// returns it unchanged. Errors: a missing column. Precondition: motion_columns() has no error.
Result<Recording> as_motion(Recording recording, const Arguments& arguments);

}  // namespace wisp::cli
