#pragma once
// Sound as WAV files (RIFF WAVE): read and written in bounded memory.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// How a sample is stored.
enum class WavSample { kPcm8, kPcm16, kPcm24, kPcm32, kFloat32, kFloat64 };

/// What a WAV file holds. A frame is one sample of every channel.
struct WavFormat {
  double rate_hz = 44100;
  int channels = 1;
  WavSample sample = WavSample::kPcm16;
};

/// Reads a WAV file from start to end in blocks: PCM of 8, 16, 24 and 32 bits, float of 32 and 64, plain or
/// WAVE_FORMAT_EXTENSIBLE, also RF64 and files that a pipe wrote (data size 0xFFFFFFFF: all to the end of the file).
class WavReader {
 public:
  /// Opens a file and reads its header.
  /// Errors, one line with the file, what was found and what was expected: cannot be opened; not RIFF WAVE; no format
  /// or no data; a coding other than those above (its number is told); rate, channels or block size that make no
  /// sense; shorter than its header says.
  static Result<WavReader> open(const std::filesystem::path& path);

  WavReader(WavReader&&) noexcept;
  WavReader& operator=(WavReader&&) noexcept;
  ~WavReader();

  const WavFormat& format() const;

  /// Frames in the file.
  std::uint64_t frames() const;

  /// Reads on into `interleaved`, full scale ±1 (NaN and infinity of a float file as they are). Returns how many
  /// samples were written: a multiple of the channels, less than asked only at the end, 0 there.
  /// Errors: the file ended or failed while being read.
  Result<std::size_t> read(std::span<float> interleaved);

 private:
  struct State;
  explicit WavReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// A whole WAV file in memory.
struct WavSound {
  WavFormat format;
  std::vector<float> samples;  ///< interleaved
};

/// Reads a whole file. Errors: as WavReader.
Result<WavSound> read_wav(const std::filesystem::path& path);

/// Reads a whole file as a recording: one input channel a track, named `sound` or `sound.0`, `sound.1`, ….
/// Errors: as WavReader; a sample that is not finite.
Result<Recording> read_wav_recording(const std::filesystem::path& path);

/// Writes a WAV file block by block, whole or not at all: it appears under its name when commit() is called.
class WavWriter {
 public:
  /// Errors: rate or channels that WAV cannot hold, the folder is missing or not writable.
  static Result<WavWriter> create(const std::filesystem::path& path, const WavFormat& format);

  WavWriter(WavWriter&&) noexcept;
  WavWriter& operator=(WavWriter&&) noexcept;
  ~WavWriter();

  /// Appends samples; PCM is rounded to nearest and clamped to full scale. Errors: the disk is full, or the file would
  /// pass 4 GiB.
  ///
  /// Precondition: interleaved.size() is a multiple of the channels.
  Result<void> write(std::span<const float> interleaved);

  /// Completes the header and gives the file its name. Errors: as write().
  Result<void> commit();

 private:
  struct State;
  explicit WavWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Writes a whole file, whole or not at all. Errors: as WavWriter.
Result<void> write_wav(const std::filesystem::path& path, const WavSound& sound);

}  // namespace wisp
