#pragma once
// From a clip on disk to a recording of an outline.

#include <filesystem>

#include "wisp/base/progress.hpp"
#include "wisp/capture/media/video.hpp"
#include "wisp/capture/vision/outline_capture.hpp"

namespace wisp {

/// How a clip is captured.
struct ClipCaptureOptions {
  OutlineCaptureOptions outline;  ///< its rate and source are set from the clip
  VideoOptions video;
};

/// Shows a capture all that a reader has; `progress` is told after each frame.
/// Errors: as VideoReader and OutlineCapture, and kStopped where `progress` returned false.
Result<void> read_into(VideoReader& reader, OutlineCapture& capture, const Progress& progress = {});

/// Captures an outline from a video file or a folder of numbered images; `progress` is told after each frame.
/// Errors: as VideoReader and OutlineCapture, and kStopped where `progress` returned false.
Result<CapturedOutline> capture_outline(const std::filesystem::path& path, const ClipCaptureOptions& options,
                                        const Progress& progress = {});

}  // namespace wisp
