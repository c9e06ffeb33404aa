#pragma once
// Reader of the frames of a video file, or of a folder of numbered images, in order.
//
// A frame's picture is borrowed: the decoder's own planes, or a copy if they must be converted, scaled or rotated. A
// frame's index is its time in periods of one fixed rate; lost frames leave gaps in the indices, each at most 2 s long.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/capture/clip/clip_capture.hpp"
#include "wisp/capture/vision/picture.hpp"

namespace wisp {

/// Options of reading a clip.
struct VideoOptions {
  double rate_hz = 0;  ///< frames per second; needed for a folder of images, overrides a video's own; 0: not given
  std::optional<FrameRange> frames;  ///< frames to read; none: all
  int turn = 0;                      ///< additional clockwise rotation beyond the file's own, in quarter turns, 0 to 3
  int threads = 1;                   ///< decoding threads, 1 to 64; more shorten wall-clock time, not processor time
};

/// Properties of a clip.
struct VideoInfo {
  int width = 0;  ///< width and height as displayed: square pixels, after rotation
  int height = 0;
  double rate_hz = 0;       ///< frames per second
  std::int64_t frames = 0;  ///< number of frames as stated, or estimated from the duration; 0: unknown
  bool images = false;      ///< a folder of images
  bool has_sound = false;   ///< the clip has a sound track (it may be silent)
  double begin = 0;         ///< first decoded frame's time after the video track's start, plus the time that gaps
                            ///< before the range were shortened by, s; 0 before the first next()
  double speed = 1;         ///< rate_hz divided by the file's own rate; the sound is played faster by this factor
};

/// One decoded frame; its picture is valid until the reader's next call.
struct VideoFrame {
  Picture picture;
  std::int64_t index = 0;  ///< 0-based index on the grid of the clip's rate
};

/// An 8-bit RGB picture, rows packed: 3 × width × height bytes.
struct RgbImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;
};

/// Returns whether a file counts as an image of a clip folder: by its extension, a number in its name, no initial dot.
bool is_numbered_image(const std::filesystem::path& path);

/// Reads a clip in bounded memory.
class VideoReader {
 public:
  /// Opens a video file or a folder of numbered images (PNG, JPEG, PGM, PPM, BMP, TIFF, in the order of their numbers).
  /// Errors: missing, not a video, cut off before its index, no video track, a codec that FFmpeg cannot decode; an
  /// empty folder, a folder without a rate; frames out of range.
  static Result<VideoReader> open(const std::filesystem::path& path, const VideoOptions& options = {});

  VideoReader(VideoReader&&) noexcept;
  VideoReader& operator=(VideoReader&&) noexcept;
  ~VideoReader();

  const VideoInfo& info() const;

  /// Returns the next frame, or nothing at the end. Errors: an image that cannot be decoded or whose size differs from
  /// the first one's (both named), a pixel format that FFmpeg cannot convert, a range that begins after a video's end.
  /// A broken frame inside a video is skipped and reported by warnings().
  Result<std::optional<VideoFrame>> next();

  /// Returns up to `count` key frames spread over a video, or over its range if one is given, without affecting next().
  /// None for a folder of images; fewer or none where the file is not seekable.
  std::vector<OwnedPicture> glimpses(int count);

  /// Returns the frame last returned by next(), as RGB. Precondition: next() has returned a frame.
  RgbImage rgb();

  /// Returns the timing of the frames decoded so far, from the clip's first frame on; valid until the next call.
  ClipTimes times() const;

  /// Returns defects that were found and worked around, one sentence each; complete after the last frame.
  std::vector<std::string> warnings() const;

 private:
  class Source;
  explicit VideoReader(std::unique_ptr<Source> source);
  std::unique_ptr<Source> source_;
};

}  // namespace wisp
