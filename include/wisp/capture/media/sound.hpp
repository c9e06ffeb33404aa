#pragma once
// Reads the sound of a WAV file or of a video, block by block.

#include <filesystem>
#include <functional>
#include <optional>
#include <span>

#include "wisp/base/result.hpp"

namespace wisp {

/// Format, length and level of a sound track.
struct SoundInfo {
  double rate_hz = 0;  ///< samples per second
  int channels = 0;
  std::size_t samples = 0;  ///< samples per channel decoded so far
  double begin = 0;         ///< start of the track, or of a block, seconds after the clip's first frame; may be < 0
  float peak = 0;           ///< largest absolute sample, full scale 1
  bool cut = false;         ///< the file is truncated: its last block is incomplete, or it states a longer duration

  /// Returns whether nothing can be heard: peak below −80 dB of full scale.
  bool silent() const { return peak < 1e-4F; }
};

/// Takes one block of interleaved samples; returns whether to continue.
using SoundBlock = std::function<bool(const SoundInfo& info, std::span<const float> samples)>;

/// Reads a sound track block by block, in bounded memory. Returns its properties, or nothing if the file has no sound
/// track. In the properties passed to `block`, `begin` is the block's start, and samples and peak include the block.
/// Errors: missing, not a sound or video file, a codec that FFmpeg cannot decode, no stated rate or channels.
Result<std::optional<SoundInfo>> stream_sound(const std::filesystem::path& path, const SoundBlock& block);

}  // namespace wisp
