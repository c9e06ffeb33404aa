// Text that claims to be a recording: whatever is accepted must be valid, and must be written back as it was.

#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>

#include "wisp/record/csv.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream stream(std::string(reinterpret_cast<const char*>(data), size));
  const auto recording = wisp::read_csv(stream, "fuzz");
  if (!recording) return 0;
  if (!wisp::check(*recording)) std::abort();
  std::istringstream again(wisp::csv_text(*recording));
  const auto copy = wisp::read_csv(again, "again");
  if (!copy || copy->rows() != recording->rows()) std::abort();
  return 0;
}
