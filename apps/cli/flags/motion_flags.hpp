#pragma once
// How a recording of motion is to be understood whose names are another program's.

#include <string>
#include <vector>

#include "command.hpp"
#include "wisp/record/csv.hpp"
#include "wisp/record/recording.hpp"

namespace wisp::cli {

/// --position and --orientation.
std::vector<Flag> motion_flags();

/// The columns that --position and --orientation name; none where they are not given.
/// Errors: not three of the one, or four of the other.
Result<std::vector<std::string>> motion_columns(const Arguments& arguments);

/// How a plain table of motion is to be understood: the names that learning looks for need no flag, where none gives
/// others, nor does the rate, where one is given. A column of time is kept, so that uneven time is found.
CsvOptions motion_table(const Arguments& arguments, double rate_hz = 0);

/// The recording with the names that learning expects: pos.x, pos.y, pos.z, q.w, q.x, q.y, q.z. Where none of the flags is
/// given it is as it was.
/// Errors: a column that is not there.
///
/// Precondition: motion_columns() has none.
Result<Recording> as_motion(Recording recording, const Arguments& arguments);

}  // namespace wisp::cli
