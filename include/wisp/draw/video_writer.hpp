#pragma once
// Writes pictures and sound to an MP4 file (H.264 video, AAC sound), or pictures with opacity to WebM (VP9) or APNG: by
// the extension .webm or .apng, else MP4.

#include <filesystem>
#include <memory>
#include <span>

#include "wisp/base/result.hpp"
#include "wisp/draw/image.hpp"

namespace wisp {

/// Options of encoding a clip.
struct VideoWriterOptions {
  int width = 0;  ///< pixels, 2 … 16384; MP4 pads odd sizes by one repeated column or row
  int height = 0;
  double rate_hz = 0;     ///< frames per second, 0.1 … 1000; rational rates such as 30000/1001 are kept exactly
  int crf = 15;           ///< constant rate factor of x264 or VP9, 0 … 51; at 15 x264 keeps the dither of soft glows
  int sound_rate_hz = 0;  ///< sample rate of a mono sound track, 7350 … 96000; 0: no sound track
  int threads = 0;        ///< threads of the video encoder; 0: one per core. The bytes depend on it
  bool loop = false;      ///< an .apng repeats for ever
};

/// Writes a film under a temporary name; finish() renames it. Destroyed before finish(), it leaves no file.
class VideoWriter {
 public:
  /// Opens the file. Errors: options out of range, the folder is missing or not writable, this FFmpeg lacks an encoder
  /// of the format.
  static Result<VideoWriter> create(const std::filesystem::path& path, const VideoWriterOptions& options);

  VideoWriter(VideoWriter&&) noexcept;
  VideoWriter& operator=(VideoWriter&&) noexcept;
  ~VideoWriter();

  /// Appends a frame; MP4 ignores opacity. Errors: a frame of another size, the encoder or the disk fails.
  Result<void> write(const Image& image);

  /// Appends sound, −1 … 1, any number of samples at any time; larger samples are clipped, NaN is silence.
  /// Errors: there is no sound track, the encoder or the disk fails.
  Result<void> write_sound(std::span<const float> samples);

  /// Completes the file and renames it to its final name. Nothing can be written afterwards.
  /// Errors: no frame was written, the encoder or the disk fails; then no file appears.
  Result<void> finish();

 private:
  struct Encoder;
  explicit VideoWriter(std::unique_ptr<Encoder> encoder);
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace wisp
