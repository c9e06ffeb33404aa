#pragma once
// An outline from a clip on disk, without its sound.

#include <filesystem>

#include "capture/capture_clip.hpp"
#include "wisp/capture/vision/outline_capture.hpp"

namespace wisp::support {

/// How a clip is captured.
struct ClipCaptureOptions {
  OutlineCaptureOptions outline;  ///< its rate and source are set from the clip
  VideoOptions video;
};

/// Captures an outline from a video file or a folder of numbered images; `progress` is told after each frame.
inline Result<CapturedOutline> capture_outline(const std::filesystem::path& path, const ClipCaptureOptions& options,
                                               const Progress& progress = {}) {
  auto reader = VideoReader::open(path, options.video);
  if (!reader) return reader.error();
  OutlineCaptureOptions outline = options.outline;
  outline.rate_hz = reader->info().rate_hz;
  outline.source = path.string();
  OutlineCapture capture(std::move(outline));
  if (auto read = read_into(*reader, capture, options.video.frames, progress); !read) return read.error();
  auto captured = capture.finish();
  if (!captured) return captured;
  for (std::string& warning : reader->warnings()) captured->report.warnings.push_back(std::move(warning));
  return captured;
}

}  // namespace wisp::support
