// Reads bytes as a MATLAB file: listed variables are read, or refused with an error. If the first byte is odd, all
// bytes are the file; if it is even, a level 5 header is put before the others.

#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "fuzz/scratch.hpp"
#include "wisp/record/mat.hpp"

namespace {

std::vector<std::uint8_t> file_of(const std::uint8_t* data, std::size_t size) {
  if (size == 0 || data[0] % 2 == 1) return {data, data + size};
  std::vector<std::uint8_t> file(128, ' ');
  file[124] = 0;
  file[125] = 1;
  file[126] = 'I';
  file[127] = 'M';
  file.insert(file.end(), data + 1, data + size);
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const wisp::fuzz::Scratch scratch;
  const auto path = scratch.write("fuzz.mat", file_of(data, size));
  const auto names = wisp::list_mat(path);
  if (!names) return 0;
  for (std::size_t k = 0; k < names->size() && k < 4; ++k) {
    const std::string name = (*names)[k].substr(0, (*names)[k].rfind(" ("));
    const auto recording = wisp::read_mat(path, {.rate_hz = 1, .outputs = {name}});
    if (recording && !wisp::check(*recording)) std::abort();
    (void)wisp::read_mat(path, {.inputs = {name + "(:,1)"}, .outputs = {name + ".u"}});
  }
  return 0;
}
