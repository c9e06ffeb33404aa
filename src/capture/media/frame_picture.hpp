#pragma once
// A decoded frame as a Picture, its own planes borrowed wherever their format allows, and as RGB.

#include <utility>
#include <vector>

#include "capture/media/libav.hpp"
#include "wisp/capture/media/video.hpp"
#include "wisp/capture/vision/picture.hpp"

namespace wisp {

/// Turns frames into pictures; keeps its converters and memory from one frame to the next.
class FramePictures {
 public:
  /// Frames are to be turned clockwise by this many quarters before they are shown, as the file asks for, and stretched
  /// to square pixels where theirs are `aspect` times as wide as high.
  explicit FramePictures(int quarter_turns = 0, double aspect = 1) : quarter_turns_(quarter_turns), aspect_(aspect) {}

  /// Width and height as they are shown, of a frame.
  std::pair<int, int> shown(int width, int height) const;

  /// The frame as a picture, good until the next call and while the frame lives. 8-bit planes and packed pixels are
  /// borrowed; other formats (palettes, more bits) are converted first.
  /// Errors: a format that FFmpeg cannot convert.
  Result<Picture> view(const AVFrame& frame);

  /// The frame as RGB, turned as it is shown.
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
