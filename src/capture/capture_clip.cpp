#include "capture/capture_clip.hpp"

namespace wisp {
namespace {

constexpr int kGlimpses = 4;

}  // namespace

Result<void> read_into(VideoReader& reader, OutlineCapture& capture, const Progress& progress) {
  for (const OwnedPicture& picture : reader.glimpses(kGlimpses)) capture.glimpse(picture.picture());
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

Result<CapturedOutline> capture_outline(const std::filesystem::path& path, const ClipCaptureOptions& options,
                                        const Progress& progress) {
  auto reader = VideoReader::open(path, options.video);
  if (!reader) return reader.error();
  OutlineCaptureOptions outline = options.outline;
  outline.rate_hz = reader->info().rate_hz;
  outline.source = path.string();
  OutlineCapture capture(std::move(outline));
  if (auto read = read_into(*reader, capture, progress); !read) return read.error();
  auto captured = capture.finish();
  if (!captured) return captured;
  for (std::string& warning : reader->warnings()) captured->report.warnings.push_back(std::move(warning));
  return captured;
}

}  // namespace wisp
