#pragma once
// Sound as WAV files (RIFF WAVE): read in bounded memory.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"

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

}  // namespace wisp
