#pragma once
// Reads the frames of a folder of numbered images.

#include "capture/media/frame_picture.hpp"
#include "capture/media/libav.hpp"
#include "wisp/capture/media/video.hpp"

namespace wisp {

class ImageFolder {
 public:
  static Result<ImageFolder> open(const std::filesystem::path& path, const VideoOptions& options);
  static bool reads(const std::filesystem::path& path);

  const VideoInfo& info() const { return info_; }
  Result<std::optional<VideoFrame>> next();
  RgbImage rgb() { return pictures_.rgb(*frame_); }
  std::vector<std::string> warnings() const;
  ClipTimes times() const { return {}; }

 private:
  struct NumberedImage {
    std::filesystem::path path;
    std::int64_t number = 0;
    std::int64_t index = 0;
  };
  static Result<std::vector<NumberedImage>> list(const std::filesystem::path& path);
  void place(std::vector<NumberedImage>& images);
  Result<void> decode(const std::filesystem::path& path);

  std::filesystem::path path_;
  std::vector<NumberedImage> images_;
  int long_gaps_ = 0;
  std::size_t at_ = 0;
  VideoInfo info_;
  CodecOwner codec_;
  PacketOwner packet_;
  FrameOwner frame_;
  FramePictures pictures_;
};

}  // namespace wisp
