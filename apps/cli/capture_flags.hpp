#pragma once
// How commands turn a clip into a recording: the flags, and the work.

#include <filesystem>

#include "command.hpp"
#include "terminal.hpp"
#include "wisp/capture/media/capture_clip.hpp"

namespace wisp::cli {

/// --points, --channel, --dark, --region, --frames, --rate.
std::vector<Flag> capture_flags();

/// A clip's outline, with the wind in its sound as input `wind` where there is any.
struct CapturedClip {
  Recording recording;
  CaptureReport report;
  bool wind_heard = false;
  double wind_background = 0;
  std::string wind_note;
};

/// Captures with the flags that were given, with a progress bar. `knots`, where not empty, are used instead of knots of
/// the clip's own, and their number of control points instead of --points: so clips can share a model.
/// Errors: as wisp::capture_outline, and a flag whose value does not fit.
Result<CapturedClip> capture_clip(const std::filesystem::path& path, const Arguments& arguments, Terminal& terminal,
                                  std::vector<double> knots = {});

}  // namespace wisp::cli
