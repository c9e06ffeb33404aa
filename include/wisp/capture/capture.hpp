#pragma once
// Captures clips on disk as recordings: outline and wind, a body from several views, brightness, falls, or wind alone.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wisp/base/progress.hpp"
#include "wisp/base/result.hpp"
#include "wisp/capture/clip/clip_capture.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Captures the outline in a video file or a folder of numbered images, and the wind in the video's sound.
/// Errors, naming the file: missing or not a clip, `points`, `frames` or `region` out of range, fewer than 10 frames
/// with an outline, sound that cannot be decoded, kStopped.
Result<Captured> capture(const std::filesystem::path& path, const ClipCapture& options, const Progress& progress = {});

/// Captures a flame's body from films of several level cameras at `azimuths` (degrees anticlockwise, seen from above),
/// aligned in time by sound or flame height, and the outline that a camera at right angles to each blow would see.
/// Errors: those of capture() for each film; fewer than two films, not one azimuth per film, equal or opposite
/// azimuths, equal films, unequal rates, `frames` given, no time in common with the first film.
Result<Captured> capture_views(std::span<const std::filesystem::path> films, std::span<const double> azimuths,
                               ClipCapture options, const Progress& progress = {});

/// Captures the brightness of a clip: the mean light of `options.region` (or of the whole picture) in every frame,
/// linear in the light that fell on the camera, as the output `brightness` of mean 1. Of the other options only
/// `frames` and `rate_hz` are used. Errors, naming the file: missing or not a clip, black throughout, a region outside
/// the picture, kStopped. `warnings`, if given, receives the clip's defects, such as lost or broken frames.
Result<Recording> capture_brightness(const std::filesystem::path& path, const ClipCapture& options,
                                     const Progress& progress = {}, std::vector<std::string>* warnings = nullptr);

/// Captures the falls of a light object that is dropped before a plain wall in a clip: see FallCapture.
/// Errors, naming the file: missing or not a clip, those of FallCapture, kStopped.
Result<Captured> capture_falls(const std::filesystem::path& path, const FallOptions& options,
                               const Progress& progress = {});

/// Estimates the wind from the sound of a clip whose picture has `frames` frames at `rate_hz` per second, or of a sound
/// file, for its whole length. Returns no frames if the sound track is missing or silent; `note` says which. Errors:
/// the file cannot be read, its sound cannot be decoded, is shorter than a frame or, without `frames`, is truncated.
/// Precondition: rate_hz > 0.
Result<ClipWind> hear_wind(const std::filesystem::path& path, double rate_hz,
                           std::optional<std::size_t> frames = std::nullopt);

/// Captures the wind from a sound file, or a film's sound, at `rate_hz` rows per second: one input, named by `measure`.
/// Errors: those of hear_wind(), and a sound track that is missing or silent. Precondition: rate_hz > 0.
Result<Recording> capture_wind(const std::filesystem::path& path, double rate_hz,
                               WindMeasure measure = WindMeasure::kSpeed);

}  // namespace wisp
