#include "wisp/capture/media/video.hpp"

#include <variant>

#include "capture/media/video_sources.hpp"

namespace wisp {

class VideoReader::Source {
 public:
  explicit Source(auto clip) : held(std::move(clip)) {}
  std::variant<VideoFile, ImageFolder> held;
};

bool is_numbered_image(const std::filesystem::path& path) { return ImageFolder::reads(path); }

VideoReader::VideoReader(std::unique_ptr<Source> source) : source_(std::move(source)) {}
VideoReader::VideoReader(VideoReader&&) noexcept = default;
VideoReader& VideoReader::operator=(VideoReader&&) noexcept = default;
VideoReader::~VideoReader() = default;

Result<VideoReader> VideoReader::open(const std::filesystem::path& path, const VideoOptions& options) {
  if (options.frames && (options.frames->first < 1 || options.frames->last < options.frames->first)) {
    return Error{path.string() + ": found frames " + std::to_string(options.frames->first) + ":" +
                 std::to_string(options.frames->last) + ", expected A:B with 1 <= A <= B"};
  }
  const auto reader_of = [](auto clip) -> Result<VideoReader> {
    if (!clip) return clip.error();
    return VideoReader(std::make_unique<Source>(std::move(clip).value()));
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return reader_of(ImageFolder::open(path, options));
  return reader_of(VideoFile::open(path, options));
}

const VideoInfo& VideoReader::info() const {
  return std::visit([](const auto& clip) -> const VideoInfo& { return clip.info(); }, source_->held);
}

Result<std::optional<VideoFrame>> VideoReader::next() {
  return std::visit([](auto& clip) { return clip.next(); }, source_->held);
}

std::vector<OwnedPicture> VideoReader::glimpses(int count) {
  auto* file = std::get_if<VideoFile>(&source_->held);
  return file ? file->glimpses(count) : std::vector<OwnedPicture>();
}

RgbImage VideoReader::rgb() {
  return std::visit([](auto& clip) { return clip.rgb(); }, source_->held);
}

ClipTimes VideoReader::times() const {
  return std::visit([](const auto& clip) { return clip.times(); }, source_->held);
}

std::vector<std::string> VideoReader::warnings() const {
  return std::visit([](const auto& clip) { return clip.warnings(); }, source_->held);
}

}  // namespace wisp
