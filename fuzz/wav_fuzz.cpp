// Bytes that claim to be a WAV file: whatever is accepted holds as many samples as it says, and they are written back.

#include <cstdint>
#include <cstdlib>

#include "fuzz/scratch.hpp"
#include "wisp/record/wav.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const wisp::fuzz::Scratch scratch;
  const auto path = scratch.write("fuzz.wav", {data, size});
  (void)wisp::read_wav_recording(path);
  const auto sound = wisp::read_wav(path);
  if (!sound) return 0;
  if (sound->samples.size() > 8 * size) std::abort();
  const auto copy = scratch.folder() / "copy.wav";
  if (!wisp::write_wav(copy, *sound)) return 0;
  const auto again = wisp::read_wav(copy);
  if (!again || again->samples.size() != sound->samples.size()) std::abort();
  return 0;
}
