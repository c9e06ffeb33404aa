#pragma once
// How commands turn a clip into a recording: flags to options.

#include <filesystem>
#include <vector>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/capture/capture.hpp"

namespace wisp::cli {

/// --points, --channel, --dark, --region, --frames, --rate, --wind-measure.
std::vector<Flag> capture_flags(const std::string& flame);

/// What they say.
/// Errors: a value that does not fit.
Result<ClipCapture> capture_options(const Arguments& arguments);

/// Recordings of outlines: tables are read, everything else is captured, with the curve of the first. A bad one is the
/// error, or is left out and listed with --skip-bad.
Result<std::vector<Recording>> outline_recordings(const std::vector<std::string>& paths, const Arguments& arguments,
                                                  Terminal& terminal);

}  // namespace wisp::cli
