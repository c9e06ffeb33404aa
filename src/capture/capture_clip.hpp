#pragma once
// Feeds the frames of a clip on disk to an OutlineCapture or a FallCapture.

#include <algorithm>
#include <optional>

#include "wisp/base/progress.hpp"
#include "wisp/capture/media/video.hpp"

namespace wisp {

/// Feeds all frames of a reader to a capture, after four glimpses if the capture has glimpse(); calls `progress` after
/// each frame. Row 0 is the first frame of `frames`, the reader's range, even if that frame is lost.
/// Errors: those of VideoReader and of the capture; kStopped if `progress` returns false.
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
    const bool part = frames && !reader.info().images;  // a folder states the frames of its range
    const std::int64_t expected = part ? frames->last - frames->first + 1 : reader.info().frames;
    const double share = expected > 0 ? std::min(1.0, static_cast<double>(++done) / static_cast<double>(expected)) : -1;
    if (!go_on(progress, "capturing", share)) return Error{std::string(kStopped)};
  }
}

}  // namespace wisp
