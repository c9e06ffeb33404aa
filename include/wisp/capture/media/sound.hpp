#pragma once
// Sound of a WAV file or of a video's track, block by block.

#include <filesystem>
#include <functional>
#include <optional>
#include <span>

#include "wisp/base/result.hpp"

namespace wisp {

/// What a sound track is.
struct SoundInfo {
  double rate_hz = 0;  ///< samples a second
  int channels = 0;
  std::size_t samples = 0;  ///< a channel, as decoded
  double begin = 0;         ///< seconds after the clip's first frame at which it, or a block, begins; may be negative
  float peak = 0;           ///< largest absolute sample, full scale 1
  bool cut = false;         ///< the last block is not whole: the file was cut off

  /// Nothing can be heard: below −80 dB of full scale.
  bool silent() const { return peak < 1e-4F; }
};

/// Takes one block of interleaved samples; returns whether to go on.
using SoundBlock = std::function<bool(const SoundInfo& info, std::span<const float> samples)>;

/// Reads a sound track block by block, in bounded memory. Returns what it was, or nothing where the file has no sound
/// track. While blocks are handed out, `info` holds rate, channels and begin.
/// Errors: missing, not a sound or video file, a codec that FFmpeg cannot decode.
Result<std::optional<SoundInfo>> stream_sound(const std::filesystem::path& path, const SoundBlock& block);

}  // namespace wisp
