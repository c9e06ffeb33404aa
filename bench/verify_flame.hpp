#pragma once
// Simulated clips for the flame's long check: filmed, listened to and captured in one process, nothing encoded.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "wisp/capture/media/clip_wind.hpp"
#include "wisp/record/recording.hpp"
#include "wisp/run/wind_track.hpp"

namespace wisp::verify {

/// A clip of a simulated candle as a camera and a microphone have it, and the truth.
struct FlameClip {
  Recording outline;             ///< captured control points, pixels, without an input
  std::vector<WindFrame> wind;   ///< heard, one a frame
  Recording truth;               ///< u:wind[m/s] and the outline as it was
  double processor_seconds = 0;  ///< that simulating, filming, listening and capturing took
};

/// What a clip is made of.
struct FlameClipChoice {
  double seconds = 20;
  std::uint64_t wind_seed = 1;
  std::uint64_t chance_seed = 1;  ///< of the camera's and the microphone's noise: what differs in another take
  std::vector<double> knots{};    ///< to express the outline in; empty: its own
};

/// Simulates, films, listens and captures.
FlameClip make_flame_clip(const FlameClipChoice& choice);

/// The same where wind and chance have one seed.
FlameClip make_flame_clip(double seconds, std::uint64_t seed, const std::vector<double>& knots = {});

/// The outline with one input, always called `wind`: heard, by that measure.
Recording driven_by_sound(const FlameClip& clip, WindMeasure measure);

/// The same with the wind as it truly was.
Recording driven_by_truth(const FlameClip& clip);

/// Recordings for a classifier to tell from what models play along their wind.
struct LikenessClips {
  std::vector<Recording> learn;  ///< outline in pixels and the heard `wind`
  std::vector<Recording> seen;   ///< the same, of clips that learning has not seen
  std::vector<Recording> again;  ///< another take of each: the same wind, other chance
};

/// Simulates them.
LikenessClips make_likeness_clips();

/// Writes feature windows of half a second of the unseen clips, of their other takes, and of what models play that were
/// learned with each kind of noise: one line each, side, clip, block, features. The features are 8 points at equal
/// steps along the outline, and their differences: what an eye sees, and not where along it the control points lie.
/// Prints what the models cost, and the longest verbatim run.
void write_likeness_windows(const LikenessClips& clips, const std::filesystem::path& file);

}  // namespace wisp::verify
