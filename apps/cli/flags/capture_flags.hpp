#pragma once
// Flags that control the conversion of a clip to a recording.

#include <filesystem>
#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/capture/capture.hpp"

namespace wisp::cli {

/// Returns --points, --channel, --flame (default `flame`), --dark, --region, --frames, --rate and --wind-measure.
std::vector<Flag> capture_flags(const std::string& flame);

/// Returns the capture options from these flags.
/// Errors: a --region of another form or without area; a --rate not above 0.
Result<ClipCapture> capture_options(const Arguments& arguments);

/// Checks before long work that all positional files exist. Errors: one is missing, unless --skip-bad leaves it out.
Result<void> check_present(const Arguments& arguments);

/// Returns the reason why a flag of clips is refused where a table is read.
std::string of_clips(const std::string& table);

/// Reads tables and captures clips, each with the knots and underside of the first outline read. A bad file is an error
/// or, with --skip-bad, skipped and listed. Errors: no file remains; a flag of clips if all files are tables; a missing
/// file; a table with another number of points than --points.
Result<std::vector<Recording>> outline_recordings(const std::vector<std::string>& paths, const Arguments& arguments,
                                                  Terminal& terminal);

}  // namespace wisp::cli
