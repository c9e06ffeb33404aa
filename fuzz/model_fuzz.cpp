// Reads bytes as a model: what is accepted is valid, can be written and read again, and runs: finite, bounded, and a
// second bank that restores the state plays the same bits.

#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "base/hash.hpp"
#include "fuzz/alive.hpp"
#include "wisp/model/file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Adds a correct header, so that the fuzzer works on the bytes behind it.
  std::vector<std::byte> bytes(32 + size);
  constexpr std::array<unsigned char, 12> kStart = {0x89, 'W', 'I', 'S', 'P', '\r', '\n', 0x1a, 1, 0, 0, 0};
  std::memcpy(bytes.data(), kStart.data(), kStart.size());
  if (size > 0) std::memcpy(bytes.data() + 32, data, size);
  const std::uint64_t facts[2] = {size, wisp::hash_bytes(std::span(bytes).subspan(32))};
  std::memcpy(bytes.data() + 16, facts, sizeof facts);

  const auto model = wisp::parse_model(bytes, "fuzz");
  if (!model) return 0;
  if (!wisp::check(*model)) std::abort();
  const auto again = wisp::model_bytes(*model);
  if (!again || !wisp::parse_model(*again, "again")) std::abort();
  auto bank = wisp::Bank::create(*model, {.capacity = 2});
  if (!bank) return 0;
  bank->spawn();
  bank->spawn();
  std::vector<float> inputs(model->inputs.size(), 0.7f);
  for (int step = 0; step < 12; ++step) {
    if (step % 3 == 0) {
      for (float& input : inputs) input = step == 9 ? 1e30f : -1.5f * input;
      bank->set_common_inputs(inputs);
    }
    bank->step();
    wisp::fuzz::expect_bounded(*bank, *model);
    wisp::fuzz::expect_unit(*bank, *model);
  }
  wisp::fuzz::expect_twin(*bank, *model, 2, 6);
  return 0;
}
