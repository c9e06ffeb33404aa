#pragma once
// From a clip to a recording: the outline in its picture, joined with the wind in its sound.

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "wisp/base/progress.hpp"
#include "wisp/base/report.hpp"
#include "wisp/base/result.hpp"
#include "wisp/capture/media/clip_wind.hpp"
#include "wisp/capture/media/video.hpp"
#include "wisp/capture/vision/image.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// How a clip's outlines are parametrised, so that another clip's can be alike.
struct SharedCurve {
  std::vector<double> knots{};      ///< the full knot vector
  std::optional<bool> underside{};  ///< whether the outline runs on along the underside; none: unknown
};

/// The curve of a recording of an outline; none where the recording has no outline or its knots are not readable.
std::optional<SharedCurve> curve_of(const Recording& recording);

/// The curve that a model of an outline expects of the recordings that it is validated on.
/// Errors: the model is not of an outline.
Result<SharedCurve> curve_of(const Model& model);

/// How a clip is captured.
struct ClipCapture {
  int points = 8;                          ///< control points, 4 to 64; 8 as in the paper
  std::optional<PixelChannel> channel{};   ///< none: the one that separates best
  bool dark = false;                       ///< the thing is dark on a light ground
  int flame = 0;                           ///< which of several flames, 1 the largest; 0: whatever moves, flame or not
  Region region{};                         ///< where to look, pixels; empty: the whole picture
  std::optional<FrameRange> frames{};      ///< 1-based and inclusive; none: all. The sound is heard from the beginning
  double rate_hz = 0;                      ///< frames a second: needed for a folder of images, overrides a video's own
  WindMeasure wind = WindMeasure::kSpeed;  ///< what is made of the sound
  std::optional<SharedCurve> curve{};      ///< of another clip; overrides `points`
};

/// How a flame is captured: the largest one, by the light that it gives.
struct FlameCapture : ClipCapture {
  FlameCapture() { flame = 1; }
};

/// A recording and what happened on the way to it.
struct Captured {
  Recording recording;  ///< outputs p0.x, p0.y, …, motion base.x, base.y, and, where the clip has sound, an input
                        ///< named by the wind's measure; one row a frame, missing rows empty
  Report
      report;  ///< whether the outline can be learned from; flames, out_at, frames, tracked, duplicates, filled,
               ///< dropped, rate_hz, points, threshold, channel, wind {…}, and the series `brightness`: the histogram
};

/// Captures the outline in a video file or a folder of numbered images, and the wind in the video's sound.
/// Errors, naming the file: missing or not a clip, `points` or `frames` out of range, fewer than 10 frames with an
/// outline, sound that cannot be decoded.
Result<Captured> capture(const std::filesystem::path& path, const ClipCapture& options, const Progress& progress = {});

/// Captures how bright a clip is: the mean light of `options.region` (or of the whole picture) in every frame, linear
/// in the light that fell on the camera, as the output `brightness` of mean 1. Other options than `frames` and
/// `rate_hz` mean nothing to it. Errors, naming the file: missing or not a clip, black throughout, a region outside the
/// picture, kStopped.
Result<Recording> capture_brightness(const std::filesystem::path& path, const ClipCapture& options,
                                     const Progress& progress = {});

/// Captures clips that are to be learned from together: all have the curve of the first, or `options.curve`.
/// Errors: as capture(), of the first clip that fails.
Result<std::vector<Captured>> capture_all(std::span<const std::filesystem::path> paths, ClipCapture options,
                                          const Progress& progress = {});

}  // namespace wisp
