#pragma once
// Reads the frames of a video file.

#include "capture/clip/frame_grid.hpp"
#include "capture/media/frame_picture.hpp"
#include "capture/media/libav.hpp"
#include "wisp/capture/media/video.hpp"

namespace wisp {

class VideoFile {
 public:
  static Result<VideoFile> open(const std::filesystem::path& path, const VideoOptions& options);

  const VideoInfo& info() const { return info_; }
  Result<std::optional<VideoFrame>> next();
  std::vector<OwnedPicture> glimpses(int count);
  RgbImage rgb() { return pictures_.rgb(*frame_); }
  std::vector<std::string> warnings() const;
  ClipTimes times() const { return {grid_->offsets(), grid_->shortened()}; }

 private:
  bool decode();
  bool send_packet();
  std::int64_t place_on_grid();
  std::int64_t decode_key_frame(std::int64_t tick, std::int64_t before);

  std::filesystem::path path_;
  VideoOptions options_;
  VideoInfo info_;
  FormatOwner format_;
  CodecOwner codec_;
  PacketOwner packet_;
  FrameOwner frame_;
  FramePictures pictures_;
  int track_ = 0;
  double aspect_ = 1;
  double seconds_per_tick_ = 0;
  bool ended_ = false;
  bool read_error_ = false;
  std::int64_t decoded_ = 0;
  std::optional<FrameGrid> grid_;
  std::int64_t broken_ = 0;
};

}  // namespace wisp
