#pragma once
// Frames of a video file, or of a folder of numbered images, one after the other.
//
// Frames are handed out as the decoder leaves them, its own planes borrowed, and each has its place on a grid of one
// fixed rate: where a clip lost frames, places stay empty.

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

/// How a clip is read.
struct VideoOptions {
  double rate_hz = 0;  ///< frames a second; needed for a folder of images, overrides a file's own; 0: none
  std::optional<FrameRange> frames;  ///< nothing: all
  int turn = 0;     ///< quarters by which pictures are turned clockwise, beyond what the file asks for, 0 to 3
  int threads = 1;  ///< decoding threads, 1 to 64; more are faster by the clock, not by the processor
};

/// What a clip says of itself.
struct VideoInfo {
  int width = 0;  ///< square pixels, as shown (after rotation)
  int height = 0;
  double rate_hz = 0;       ///< frames a second
  std::int64_t frames = 0;  ///< as stated, or as guessed from its duration; 0 where unknown
  bool images = false;      ///< a folder of images
  bool has_sound = false;   ///< a sound track is there (it may be silent)
  double begin = 0;         ///< of the first frame that was read, seconds after the first of the track
};

/// One decoded frame; its picture is good until the next call of the reader.
struct VideoFrame {
  Picture picture;
  std::int64_t index = 0;  ///< 0-based place on the grid of the clip's rate
};

/// An 8-bit RGB picture, rows packed: 3 × width × height bytes.
struct RgbImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;
};

/// Whether a file is read as one of the images where its folder is a clip: by its ending, and a number in its name.
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

  /// The next frame, or nothing at the end.
  /// Errors: an image that cannot be decoded or has another size than the first (both named). A broken frame inside a
  /// video is left out, and told of in warnings().
  Result<std::optional<VideoFrame>> next();

  /// Up to `count` pictures spread over the clip's whole length, cheap to come by (a video's key frames); what next()
  /// gives is not changed. None of a folder of
  /// images, fewer or none where the file cannot be searched.
  std::vector<OwnedPicture> glimpses(int count);

  /// The frame that next() gave last, as RGB.
  ///
  /// Precondition: next() has given a frame.
  RgbImage rgb();

  /// When frames came that were not in their places, from the clip's first frame on; good until the next call.
  ClipTimes times() const;

  /// What was found wrong and got over, one sentence each; complete after the last frame.
  std::vector<std::string> warnings() const;

 private:
  class Source;
  explicit VideoReader(std::unique_ptr<Source> source);
  std::unique_ptr<Source> source_;
};

}  // namespace wisp
