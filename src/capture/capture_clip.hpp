#pragma once
// Feeds a clip on disk to a capture.

#include <algorithm>
#include <optional>

#include "wisp/base/progress.hpp"
#include "wisp/capture/media/video.hpp"

namespace wisp {

/// Feeds all frames of a reader to a capture, after glimpses if it takes them; calls `progress` after each frame. The
/// first row is the first of `frames`, the reader's range, even if that frame is lost.
/// Errors: as VideoReader and the capture, of an outline or of falls, and kStopped where `progress` returned false.
template <class Capture>
Result<void> read_into(VideoReader& reader, Capture& capture, const std::optional<FrameRange>& frames,
                       const Progress& progress = {}) {
  if constexpr (requires { capture.glimpse(Picture{}); }) {
    for (const OwnedPicture& picture : reader.glimpses(4)) capture.glimpse(picture.picture());
  }
  std::int64_t done = 0, expected_index = frames ? frames->first - 1 : 0;
  while (true) {
    auto frame = reader.next();
    if (!frame) return frame.error();
    if (!frame->has_value()) return {};
    const VideoFrame& now = **frame;
    capture.lost(static_cast<int>(now.index - expected_index));
    expected_index = now.index + 1;
    if (auto fed = capture.feed(now.picture); !fed) return fed.error();
    const std::int64_t expected = reader.info().frames;
    const double share = expected > 0 ? std::min(1.0, static_cast<double>(++done) / static_cast<double>(expected)) : -1;
    if (!go_on(progress, "capturing", share)) return Error{std::string(kStopped)};
  }
}

}  // namespace wisp
