#pragma once
// From frames of something light that is dropped before a plain wall to a recording of its falls.
//
// The wall is the median of the film: what is to be seen can only be decided when the film is over, so small pictures
// of all frames are kept until then.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/capture/clip/clip_capture.hpp"
#include "wisp/capture/vision/picture.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

namespace fall {
struct Fall;
}

/// How falls are captured.
struct FallOptions {
  double height_metres = 0;            ///< how much of the wall the picture's height shows, 0.01 to 100; 0: not known,
                                       ///< 1 is taken
  Region region{};                     ///< where to look, pixels; empty: the whole picture
  std::optional<FrameRange> frames{};  ///< of a file: 1-based and inclusive; none: all
  double rate_hz = 0;                  ///< of a file: frames a second, needed for a folder of images, overrides a
                                       ///< video's own: a film in slow motion has the rate that it was filmed at
  std::size_t max_bytes = 384u << 20;  ///< of small pictures that are kept, one byte a pixel: about 6900 frames of a
                                       ///< wide film
};

/// What is seen while a film comes in, for whoever watches.
struct FallSeen {
  std::size_t frames = 0;      ///< rows so far, lost frames included
  std::size_t max_frames = 0;  ///< that fit; 0 before the first
  Region moving{};             ///< box of what moved since the frame before, pixels; empty: nothing
};

/// Captures falls from frames that are fed in their order.
class FallCapture {
 public:
  /// Errors: a rate that is none, a height out of range.
  static Result<FallCapture> create(const ClipSource& source, const FallOptions& options = {});

  /// Takes in the next frame; it is borrowed for the call.
  /// Errors: a frame of another size than the first, a region outside the picture, more frames than fit.
  Result<void> feed(const Picture& picture);

  /// Notes that the film lost `count` frames here.
  void lost(int count = 1);

  /// What the frames so far have shown.
  FallSeen seen() const;

  /// Ends the film. Returns the recording: outputs pos.x, pos.y (0: a picture is flat), pos.z in metres, z up, from the
  /// middle of the picture's lower border; where the thing is long enough to tell how it lies, q.w, q.x, q.y, q.z: its
  /// long axis, the body's second, and its normal, the third, lie in the picture. Flag `filled`. One episode a fall,
  /// one row a frame, none missing.
  /// Errors: no fall, and why: nothing moves, everything moves, or only what touches the picture's edge does.
  Result<Captured> finish();

 private:
  FallCapture(ClipSource source, const FallOptions& options);
  std::vector<std::uint8_t> reduced(const Picture& picture) const;
  double metres_per_pixel() const;
  Recording recorded(const std::vector<fall::Fall>& falls, bool tilt) const;

  ClipSource source_;
  FallOptions options_;
  Region frame_{};   // of the first picture; empty: none yet
  Region region_{};  // that is looked at
  int step_ = 1;     // pixels that make one of the small picture, either way
  int width_ = 0;    // of the small pictures
  int height_ = 0;
  std::vector<std::vector<std::uint8_t>> frames_;  // empty: lost
  Region moving_{};
};

}  // namespace wisp
