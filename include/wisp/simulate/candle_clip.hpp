#pragma once
// A clip of a candle in wind, with sound, and the truth beside it.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"
#include "wisp/simulate/candle_rig.hpp"
#include "wisp/simulate/flame_outline.hpp"
#include "wisp/simulate/virtual_camera.hpp"
#include "wisp/simulate/virtual_microphone.hpp"
#include "wisp/simulate/wind_signal.hpp"

namespace wisp {

/// The clip. Its frame rate is rig.rate_hz.
struct CandleClipOptions {
  CandleRigOptions rig;
  VirtualCameraOptions camera;
  VirtualMicrophoneOptions microphone;
  FlameOutlineRecipe outline;
  WindSignalOptions wind;
  std::optional<Recording> wind_recording;  ///< where set, its wind is taken and `wind` is not
  std::string wind_channel;                 ///< of that recording; empty: its only input
  double seconds = 60;                      ///< length, more than 0, at most 86400
  double settle_seconds = 1.5;  ///< simulated in still air before the first frame, 0 … 60: until the flame burns evenly
  int threads = 2;              ///< 1 or 2: the second draws and writes frames while the first simulates; the clip is
                                ///< the same to the last bit
};

/// Puts the candle into the middle of picture and grid and widens the grid by a quarter: room for a flame that leans to
/// both sides, for a wind with `both_sides`.
void centre_candle(CandleClipOptions& options);

/// A frame on its way out.
struct CandleFrame {
  std::uint64_t index = 0;
  double seconds = 0;  ///< since the clip's start
  int width = 0;
  int height = 0;
  std::span<const std::uint8_t> picture;  ///< rows from the top, RGB, width × height × 3; valid during the call only
};

/// What the clip leaves by. Each is called from the thread that called simulate_candle, in the order of time: a
/// frame's picture first, then the sound that was heard while it lasted. An error ends the clip and is passed on.
struct CandleClipOutputs {
  std::function<Result<void>(const CandleFrame&)> on_frame;
  std::function<Result<void>(std::span<const float>)> on_sound;  ///< mono, microphone.rate_hz, within ±1
  std::function<void(double share)> on_progress;                 ///< 0 … 1, once a frame
};

/// Simulates a candle, films it and listens to it.
/// Returns the truth, one row a frame: u:wind[m/s] (at the frame's end), y:tip.x, y:tip.y, y:height [mm],
/// y:lean[deg], y:brightness[mm2], y:lit[1], and the outline's control points y:p0.x[px], y:p0.y[px], … in pixels of
/// the picture; tip and outline are missing (NaN) while there is no flame. Attributes tell the view (pixels_per_mm,
/// origin_x, origin_y), the seed, and the grid.
/// Errors: an option outside its range (which, what was found, what was expected), a wind channel that is not there,
/// whatever an output returned, or a flow that left the finite numbers (a defect; never seen).
Result<Recording> simulate_candle(const CandleClipOptions& options, const CandleClipOutputs& outputs);

}  // namespace wisp
