#pragma once
// How commands turn a clip into a recording: the flags, and the work.

#include <filesystem>
#include <optional>
#include <vector>

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

/// How another clip's outlines run, for clips to share a model: knots, in the place of the clip's own and of --points,
/// and whether the underside is followed, where that is known.
struct SharedCurve {
  std::vector<double> knots{};  ///< empty: there is no other clip
  std::optional<bool> underside{};
};

/// Captures with the flags that were given, with a progress bar.
/// Errors: as wisp::capture_outline, and a flag whose value does not fit.
Result<CapturedClip> capture_clip(const std::filesystem::path& path, const Arguments& arguments, Terminal& terminal,
                                  SharedCurve curve = {});

}  // namespace wisp::cli
