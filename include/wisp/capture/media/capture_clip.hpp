#pragma once
// From a clip on disk to a recording of an outline.

#include <cstdint>
#include <filesystem>
#include <functional>

#include "wisp/capture/media/video.hpp"
#include "wisp/capture/vision/outline_capture.hpp"

namespace wisp {

/// How a clip is captured.
struct ClipCaptureOptions {
  OutlineCaptureOptions outline;  ///< its rate and source are set from the clip
  VideoOptions video;
};

/// Told after each frame how many are done and how many are expected (0: not known); returns whether to go on.
using CaptureProgress = std::function<bool(std::int64_t done, std::int64_t expected)>;

/// Captures an outline from a video file or a folder of numbered images.
/// Errors: as VideoReader and OutlineCapture, and "stopped" where `progress` returned false.
Result<CapturedOutline> capture_outline(const std::filesystem::path& path, const ClipCaptureOptions& options,
                                        const CaptureProgress& progress = {});

}  // namespace wisp
