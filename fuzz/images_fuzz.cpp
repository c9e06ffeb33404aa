// Reads bytes as a folder of numbered images. Of each image: a byte for its kind, two for its number, two for its
// length in bytes, and its bytes.

#include <cstdint>
#include <cstdlib>
#include <string>

#include "fuzz/scratch.hpp"
#include "fuzz/source.hpp"
#include "wisp/capture/media/video.hpp"

namespace {

void play(const std::filesystem::path& path, const wisp::VideoOptions& options) {
  auto reader = wisp::VideoReader::open(path, options);
  if (!reader) return;
  (void)reader->glimpses(2);
  std::int64_t last = -1;
  for (int frames = 0; frames < 20; ++frames) {
    const auto frame = reader->next();
    if (!frame || !frame->has_value()) break;
    if ((*frame)->index <= last) std::abort();
    last = (*frame)->index;
    if ((*frame)->picture.width < 1 || (*frame)->picture.height < 1) std::abort();
    (void)reader->rgb();
  }
  (void)reader->warnings();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const wisp::fuzz::Scratch scratch;
  static const char* kinds[] = {".png", ".jpg", ".pgm", ".ppm", ".bmp", ".tif"};
  scratch.clear();
  wisp::fuzz::Source source(data, size);
  for (int k = 0; k < 8 && !source.empty(); ++k) {
    const auto kind = source.take<std::uint8_t>();
    const auto number = source.take<std::uint16_t>();
    const std::size_t wanted = source.take<std::uint16_t>();
    const auto bytes = source.rest().first(std::min(wanted, source.rest().size()));
    // Bit 7 of the kind multiplies the number by 10¹².
    const std::string digits = std::to_string(number) + (kind & 0x80 ? "000000000000" : "");
    scratch.write(digits + kinds[(kind & 0x7f) % 6], bytes);
    source = wisp::fuzz::Source(source.rest().data() + bytes.size(), source.rest().size() - bytes.size());
  }
  play(scratch.folder(), {.rate_hz = 30, .frames = std::nullopt, .threads = 1});
  return 0;
}
