#pragma once
// Converts a decoded frame to a Picture, borrowing its planes where their format allows, and to RGB.

#include <utility>
#include <vector>

#include "capture/media/libav.hpp"
#include "wisp/capture/media/video.hpp"
#include "wisp/capture/vision/picture.hpp"

namespace wisp {

/// Converts frames to pictures; reuses converters and memory between frames.
class FramePictures {
 public:
  /// Frames are rotated clockwise by this many quarter turns, as the file requests, and stretched to square pixels
  /// where a pixel's width is `aspect` times its height.
  explicit FramePictures(int quarter_turns = 0, double aspect = 1) : quarter_turns_(quarter_turns), aspect_(aspect) {}

  /// Width and height of a frame as displayed.
  std::pair<int, int> shown(int width, int height) const;

  /// The frame as a picture, valid until the next call and while the frame exists. 8-bit planes and packed pixels are
  /// borrowed; other formats (palettes, more bits) are converted first.
  /// Errors: a format that FFmpeg cannot convert.
  Result<Picture> view(const AVFrame& frame);

  /// The frame as RGB, rotated for display.
  RgbImage rgb(const AVFrame& frame);

 private:
  std::pair<int, int> stretched(int width, int height) const;
  Result<const AVFrame*> plain(const AVFrame& frame);
  Picture turned(const Picture& picture);

  int quarter_turns_ = 0;
  double aspect_ = 1;
  ScalerOwner to_plain_;
  ScalerOwner to_rgb_;
  FrameOwner plain_;
  FrameOwner rgb_;
  std::vector<std::uint8_t> turned_;
};

}  // namespace wisp
