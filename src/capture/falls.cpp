#include "wisp/capture/capture.hpp"
#include "wisp/capture/media/video.hpp"

namespace wisp {

Result<Captured> capture_falls(const std::filesystem::path& path, const FallOptions& options,
                               const Progress& progress) {
  auto reader = VideoReader::open(path, {.rate_hz = options.rate_hz, .frames = options.frames});
  if (!reader) return reader.error();
  const VideoInfo& info = reader->info();
  auto capture = FallCapture::create({path.string(), info.rate_hz, info.images}, options);
  if (!capture) return capture.error();
  std::int64_t place = -1;
  for (;;) {
    const auto frame = reader->next();
    if (!frame) return frame.error();
    if (!*frame) break;
    if (place >= 0) capture->lost(static_cast<int>((*frame)->index - place));
    place = (*frame)->index + 1;
    if (auto fed = capture->feed((*frame)->picture); !fed) return fed.error();
    const double done = static_cast<double>(capture->seen().frames);
    if (!go_on(progress, "capturing", info.frames > 0 ? done / static_cast<double>(info.frames) : -1))
      return Error{std::string(kStopped)};
  }
  auto captured = capture->finish();
  if (!captured) return captured;
  for (std::string& warning : reader->warnings()) captured->report.warnings.push_back(std::move(warning));
  return captured;
}

}  // namespace wisp
