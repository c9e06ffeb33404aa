#pragma once
// The wind in a clip's sound, one value a frame of its picture (section 3.3 of the paper).

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/run/wind_track.hpp"

namespace wisp {

/// What was heard in a clip.
struct ClipWind {
  std::vector<WindFrame> frames;  ///< one a frame of the picture; empty where nothing can be heard
  double background = 0;          ///< root mean square of the stretches without wind, full scale 1
  double clipped_share = 0;       ///< of samples at full scale
  std::size_t uncovered = 0;      ///< frames of the picture that the sound does not reach: their wind is missing (NaN)
  std::string note;               ///< one clause for people: what was heard, or why nothing was
};

/// Hears the wind of a clip whose picture has `frames` frames at `rate_hz` a second.
/// Returns no frames where there is no sound track or a silent one; `note` tells which.
/// Errors: the file cannot be read, or its sound cannot be decoded.
///
/// Precondition: rate_hz > 0.
Result<ClipWind> hear_wind(const std::filesystem::path& path, double rate_hz, std::size_t frames);

}  // namespace wisp
