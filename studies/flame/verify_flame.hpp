#pragma once
// Simulated clips for the flame's long check: filmed, listened to and captured in one process, nothing encoded.

#include <cstdint>
#include <string>
#include <vector>

#include "wisp/capture/clip/clip_capture.hpp"
#include "wisp/record/recording.hpp"
#include "wisp/sound/wind_track.hpp"

namespace wisp::verify {

/// A clip of a simulated candle as a camera and a microphone have it, and the truth.
struct FlameClip {
  Recording outline;             ///< captured control points, pixels, without an input
  std::vector<WindFrame> wind;   ///< heard, one a frame
  double one_rms = 0;            ///< of the sound, where the wind is 1
  Recording truth;               ///< u:wind[m/s] and the outline as it was
  double processor_seconds = 0;  ///< that simulating, filming, listening and capturing took
};

/// What blows.
enum class FlameWind {
  kCalm,  ///< a closed room's draughts, which are hardly heard
  kGusts,
  kPuffs,  ///< every five seconds, of which some kill; where it went out the candle is lit again
};

/// What a clip is made of.
struct FlameClipChoice {
  double seconds = 20;
  std::uint64_t wind_seed = 1;
  std::uint64_t chance_seed = 1;  ///< of the camera's and the microphone's noise: what differs in another take
  std::vector<double> knots{};    ///< to express the outline in; empty: its own
  FlameWind wind = FlameWind::kGusts;
};

/// Simulates, films, listens and captures.
FlameClip make_flame_clip(const FlameClipChoice& choice);

/// The same where wind and chance have one seed.
FlameClip make_flame_clip(double seconds, std::uint64_t seed, const std::vector<double>& knots = {});

/// The outline with one input, always called `wind`: heard, by that measure.
Recording driven_by_sound(const FlameClip& clip, WindMeasure measure);

/// The same with the wind as it truly was.
Recording driven_by_truth(const FlameClip& clip);

}  // namespace wisp::verify
