#pragma once
// Feeds a clip on disk to a capture.

#include "wisp/base/progress.hpp"
#include "wisp/capture/media/video.hpp"

namespace wisp {

/// Feeds all frames of a reader to a capture, after glimpses if it takes them; calls `progress` after each frame.
/// Errors: as VideoReader and the capture, of an outline or of falls, and kStopped where `progress` returned false.
template <class Capture>
Result<void> read_into(VideoReader& reader, Capture& capture, const Progress& progress = {}) {
  if constexpr (requires { capture.glimpse(Picture{}); }) {
    for (const OwnedPicture& picture : reader.glimpses(4)) capture.glimpse(picture.picture());
  }
  std::int64_t done = 0, expected_index = -1;
  while (true) {
    auto frame = reader.next();
    if (!frame) return frame.error();
    if (!frame->has_value()) return {};
    const VideoFrame& now = **frame;
    if (expected_index >= 0) capture.lost(static_cast<int>(now.index - expected_index));
    expected_index = now.index + 1;
    if (auto fed = capture.feed(now.picture); !fed) return fed.error();
    const std::int64_t expected = reader.info().frames;
    const double share = expected > 0 ? static_cast<double>(++done) / static_cast<double>(expected) : -1;
    if (!go_on(progress, "capturing", share)) return Error{std::string(kStopped)};
  }
}

}  // namespace wisp
