#pragma once
// The ear of a scene: sound in, wind out, and whether anyone listens.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/record/wav.hpp"
#include "wisp/sound/wind_level.hpp"

namespace wisp::window {

/// Where sound comes from.
enum class EarState {
  kOff,  ///< nobody asked for it, or it was switched off
  kListening,
  kMissing,  ///< there is no microphone, or it was lost
};

/// The wind in a stream of sound.
class Ear {
 public:
  /// Begins with what was known of the microphone, if anything.
  /// Errors: as WindLevel::create().
  Result<void> open(const SoundFormat& format, std::optional<WindCalibration> known = {});

  /// Stops listening; its wind is 0 then.
  void close(EarState state = EarState::kOff);

  /// Takes interleaved samples. Ignored while closed.
  void hear(std::span<const float> samples);

  /// The wind now, 1 a strong gust; 0 unless listening.
  float wind() const;

  /// How loud it is, 0 … 1, for the indicator.
  float loudness() const;

  EarState state() const;

  /// What was learned of the room, while open.
  std::optional<WindCalibration> calibration() const;

 private:
  std::optional<WindLevel> level_;
  EarState closed_ = EarState::kOff;
};

/// A WAV file in place of a microphone: its samples come as time passes, and end in silence.
class SoundFile {
 public:
  /// Errors: as WavReader::open(), or an empty file.
  static Result<SoundFile> open(const std::string& path);

  const SoundFormat& format() const { return format_; }

  /// The samples up to that time since the start, as blocks of `block` samples a channel, which come only whole, as
  /// from a microphone. The span is good until the next call.
  std::span<const float> until(double seconds, int block);

 private:
  SoundFormat format_;
  std::vector<float> samples_;
  std::size_t taken_ = 0;  // of all channels
};

}  // namespace wisp::window
