// Bytes that claim to be a model: whatever is accepted must be valid, and must run.

#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"

namespace {

std::uint64_t fnv(const std::uint8_t* data, std::size_t size) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (std::size_t k = 0; k < size; ++k) hash = (hash ^ data[k]) * 0x100000001b3u;
  return hash;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // The header is made right, so that the fuzzer works on what lies behind it.
  std::vector<std::byte> bytes(32 + size);
  constexpr std::array<unsigned char, 12> kStart = {0x89, 'W', 'I', 'S', 'P', '\r', '\n', 0x1a, 1, 0, 0, 0};
  std::memcpy(bytes.data(), kStart.data(), kStart.size());
  const std::uint64_t facts[2] = {size, fnv(data, size)};
  std::memcpy(bytes.data() + 16, facts, sizeof facts);
  if (size > 0) std::memcpy(bytes.data() + 32, data, size);

  const auto model = wisp::parse_model(bytes, "fuzz");
  if (!model) return 0;
  if (!wisp::check(*model)) std::abort();
  auto bank = wisp::Bank::create(*model);
  if (!bank) return 0;
  bank->spawn();
  for (int step = 0; step < 4; ++step) bank->step();
  return 0;
}
