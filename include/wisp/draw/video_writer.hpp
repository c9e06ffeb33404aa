#pragma once
// Pictures and sound into an MP4 file: H.264 video, AAC sound. And pictures with opacity into WebM (VP9) and APNG, by
// the name.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "wisp/base/result.hpp"
#include "wisp/draw/image.hpp"

namespace wisp {

/// How a clip is encoded.
struct VideoWriterOptions {
  int width = 0;  ///< pixels, 2 … 16384; odd sizes are padded by one repeated column or row
  int height = 0;
  double rate_hz = 0;     ///< frames a second, 0.1 … 1000; 30000/1001 and its like are kept exactly
  int crf = 15;           ///< x264's constant rate factor, 0 (lossless) … 51; at 15 soft glows keep their dither
  int sound_rate_hz = 0;  ///< samples a second of a mono sound track, such as 44100; 0: no sound track
  int threads = 0;        ///< of the video encoder; 0: one a core. The bytes depend on it
  bool loop = false;      ///< of an .apng: plays for ever
};

/// Writes a film under a temporary name; finish() renames it. Destroyed before that, no file is left.
class VideoWriter {
 public:
  /// Opens the file. Errors: options out of range, the folder is missing or not writable, no H.264 or AAC encoder in
  /// this FFmpeg.
  static Result<VideoWriter> create(const std::filesystem::path& path, const VideoWriterOptions& options);

  VideoWriter(VideoWriter&&) noexcept;
  VideoWriter& operator=(VideoWriter&&) noexcept;
  ~VideoWriter();

  /// Appends a frame; MP4 ignores opacity. Errors: a frame of another size, the encoder or the disk fails.
  Result<void> write(const Image& image);

  /// Appends sound, −1 … 1, any number of samples at any time; what is beyond is clipped, NaN is silence.
  /// Errors: there is no sound track, the encoder or the disk fails.
  Result<void> write_sound(std::span<const float> samples);

  /// Completes the file and gives it its name. Nothing can be written afterwards.
  /// Errors: no frame was written, the encoder or the disk fails; then no file appears.
  Result<void> finish();

 private:
  struct Encoder;
  explicit VideoWriter(std::unique_ptr<Encoder> encoder);
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace wisp
