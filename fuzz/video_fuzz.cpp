// Reads bytes as a clip with sound, in any container.

#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "fuzz/scratch.hpp"
#include "wisp/capture/media/sound.hpp"
#include "wisp/capture/media/video.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const wisp::fuzz::Scratch scratch;
  const auto path = scratch.write("fuzz.clip", {data, size});
  auto reader = wisp::VideoReader::open(path, {.rate_hz = 0, .frames = std::nullopt, .threads = 1});
  if (reader) {
    (void)reader->glimpses(2);
    std::int64_t last = -1;
    for (int frames = 0; frames < 30; ++frames) {
      const auto frame = reader->next();
      if (!frame || !frame->has_value()) break;
      if ((*frame)->index <= last) std::abort();
      last = (*frame)->index;
      (void)reader->rgb();
    }
    (void)reader->warnings();
  }
  std::size_t blocks = 0;
  (void)wisp::stream_sound(path, [&](const wisp::SoundInfo& info, std::span<const float> samples) {
    if (info.channels < 1 || samples.size() % static_cast<std::size_t>(info.channels) != 0) std::abort();
    for (float sample : samples) {
      if (!std::isfinite(sample)) std::abort();
    }
    return ++blocks < 200;
  });
  return 0;
}
