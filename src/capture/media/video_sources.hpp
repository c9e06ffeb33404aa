#pragma once
// Readers of a video file and of a folder of numbered images, and conversion of their frames to RGB or to a Picture,
// which borrows a frame's planes where their format allows.

#include <utility>
#include <vector>

#include "capture/clip/frame_grid.hpp"
#include "capture/media/libav.hpp"
#include "wisp/capture/media/video.hpp"
#include "wisp/capture/vision/picture.hpp"

namespace wisp {

/// Converts frames to pictures; reuses converters and memory between frames.
class FramePictures {
 public:
  /// Frames with pixels `aspect` times as wide as high are made square, then turned clockwise by `quarter_turns`.
  explicit FramePictures(int quarter_turns = 0, double aspect = 1) : quarter_turns_(quarter_turns), aspect_(aspect) {}

  /// Width and height of a frame as displayed.
  std::pair<int, int> shown(int width, int height) const;

  /// Returns the frame as a picture, valid until the next call and while the frame exists. 8-bit planes and packed
  /// pixels are borrowed unless rotated or stretched; other formats (palettes, more bits) are converted first.
  /// Errors: a format that FFmpeg cannot convert.
  Result<Picture> view(const AVFrame& frame);

  /// Returns the frame as RGB, stretched and rotated; black where its format cannot be converted.
  RgbImage rgb(const AVFrame& frame);

 private:
  std::pair<int, int> stretched(int width, int height) const;
  Result<const AVFrame*> plain(const AVFrame& frame);
  Picture turned(const Picture& picture);

  int quarter_turns_ = 0;
  double aspect_ = 1;
  ScalerOwner to_plain_;
  FrameOwner plain_;
  FrameOwner narrow_;
  std::vector<std::uint8_t> turned_;
};

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

class VideoFile {
 public:
  static Result<VideoFile> open(const std::filesystem::path& path, const VideoOptions& options);

  const VideoInfo& info() const { return info_; }
  Result<std::optional<VideoFrame>> next();
  std::vector<OwnedPicture> glimpses(int count);
  RgbImage rgb() { return pictures_.rgb(*frame_); }
  std::vector<std::string> warnings() const;
  ClipTimes times() const { return {grid_->offsets(), shortened_}; }

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
  PacketReader packets_;
  PacketOwner packet_;
  FrameOwner frame_;
  FramePictures pictures_;
  int track_ = 0;
  double aspect_ = 1;
  double seconds_per_tick_ = 0;
  bool ended_ = false;
  bool read_error_ = false;
  std::int64_t decoded_ = 0;
  double end_ = 0;  // end of the packets read, of any track, seconds after the file's beginning
  std::optional<FrameGrid> grid_;
  std::optional<int> holes_before_;  // number of gaps shortened before the first frame returned by next()
  int shortened_ = 0;                // and from there up to the last one
  std::int64_t broken_ = 0;
};

}  // namespace wisp
