#pragma once
// The wind in a clip's sound, one value a frame of its picture (section 3.3 of the paper).

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/sound/wind_track.hpp"

namespace wisp {

/// What is made of the sound, and the name of the channel that holds it. Names differ, so that a model that was
/// learned from one is never driven by another.
enum class WindMeasure {
  kSpeed,  ///< "wind": proportional to wind speed, 0 where nothing is heard, held back under other sounds
  kHeard,  ///< "wind.heard": proportional to wind speed, other sounds included
  kRms,    ///< "wind.rms": the paper's plain root mean square, less the background's; full scale 1
};

/// The channel's name.
std::string wind_channel_name(WindMeasure measure);

/// A frame's value.
double wind_value(const WindFrame& frame, WindMeasure measure);

/// What was heard in a clip.
struct ClipWind {
  std::vector<WindFrame> frames;  ///< one a frame of the picture; empty where nothing can be heard
  double background = 0;          ///< root mean square of the stretches without wind, full scale 1
  double one_rms = 0;             ///< of the wind's band where speed is 1, full scale 1
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
