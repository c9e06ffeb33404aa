// Bytes that claim to be a WAV file: whatever is accepted holds as many samples as it says.

#include <cstdint>
#include <cstdlib>

#include "fuzz/scratch.hpp"
#include "wisp/record/wav.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const wisp::fuzz::Scratch scratch;
  const auto sound = wisp::read_wav(scratch.write("fuzz.wav", {data, size}));
  if (sound && sound->samples.size() > 8 * size) std::abort();
  return 0;
}
