#pragma once
// A sound track read whole.

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "wisp/capture/media/sound.hpp"

namespace wisp::support {

struct Sound {
  SoundInfo info;
  std::vector<float> samples;  // channels interleaved, full scale 1
};

inline Result<std::optional<Sound>> read_sound(const std::filesystem::path& path) {
  Sound sound;
  const auto info = stream_sound(path, [&](const SoundInfo&, std::span<const float> samples) {
    sound.samples.insert(sound.samples.end(), samples.begin(), samples.end());
    return true;
  });
  if (!info) return info.error();
  if (!*info) return std::optional<Sound>();
  sound.info = **info;
  return std::optional<Sound>(std::move(sound));
}

}  // namespace wisp::support
