#pragma once
// From a clip's file to a recording: the outline in its picture, joined with the wind in its sound.

#include <filesystem>
#include <optional>
#include <span>

#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/capture/clip/clip_capture.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Captures the outline in a video file or a folder of numbered images, and the wind in the video's sound.
/// Errors, naming the file: missing or not a clip, `points` or `frames` out of range, fewer than 10 frames with an
/// outline, sound that cannot be decoded.
Result<Captured> capture(const std::filesystem::path& path, const ClipCapture& options, const Progress& progress = {});

/// Captures a flame from films of several level cameras at these azimuths, in degrees anticlockwise from above, joined
/// in time by their sounds or the flame's height: its body, and its outline from beside each blow. Errors: as capture()
/// of each; fewer than two films, not one angle each, one that another film has, other rates, no time in common.
Result<Captured> capture_views(std::span<const std::filesystem::path> films, std::span<const double> azimuths,
                               ClipCapture options, const Progress& progress = {});

/// Captures how bright a clip is: the mean light of `options.region` (or of the whole picture) in every frame, linear
/// in the light that fell on the camera, as the output `brightness` of mean 1. Other options than `frames` and
/// `rate_hz` mean nothing to it. Errors, naming the file: missing or not a clip, black throughout, a region outside the
/// picture, kStopped.
Result<Recording> capture_brightness(const std::filesystem::path& path, const ClipCapture& options,
                                     const Progress& progress = {});

/// Captures the falls of something light that is dropped before a plain wall in a clip: see FallCapture.
/// Errors, naming the file: missing or not a clip, as FallCapture, kStopped.
Result<Captured> capture_falls(const std::filesystem::path& path, const FallOptions& options,
                               const Progress& progress = {});

/// Hears the wind of a clip whose picture has `frames` frames at `rate_hz` a second; of a sound file, which has none,
/// as many as it lasts. Returns no frames where there is no sound track or a silent one; `note` tells which. Errors:
/// the file cannot be read, or its sound cannot be decoded.
///
/// Precondition: rate_hz > 0.
Result<ClipWind> hear_wind(const std::filesystem::path& path, double rate_hz,
                           std::optional<std::size_t> frames = std::nullopt);

/// Captures the wind in a sound file, or in a film's sound, `rate_hz` rows a second: one input named by its measure.
/// Errors: as hear_wind(), and sound in which nothing can be heard.
///
/// Precondition: rate_hz > 0.
Result<Recording> capture_wind(const std::filesystem::path& path, double rate_hz,
                               WindMeasure measure = WindMeasure::kSpeed);

}  // namespace wisp
