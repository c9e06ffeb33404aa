// A bank under anything that a game could do to it, bytes that claim to be its state included: whatever happens,
// outputs are numbers between their range and 0, and a bank that was restored can be saved again.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "../tests/run/flame_model.hpp"
#include "base/hash.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace {

// Takes numbers off the front of the input; zeros when it is used up.
class Source {
 public:
  Source(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  bool empty() const { return size_ == 0; }

  template <class Number>
  Number take() {
    Number number{};
    const std::size_t count = size_ < sizeof number ? size_ : sizeof number;
    std::memcpy(&number, data_, count);
    data_ += count;
    size_ -= count;
    return number;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

const wisp::Model& model() {
  static const wisp::Model flame = [] {
    auto made = wisp::flame_model({.points = 4, .wind = wisp::InputShape::kSplitSign, .noise_rank = 1});
    made.extinction.emplace();
    return made;
  }();
  return flame;
}

void expect_in_range(const wisp::Bank& bank) {
  std::vector<float> values(static_cast<std::size_t>(bank.slots()) * bank.output_count());
  bank.outputs(values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!bank.valid(bank.at(static_cast<int>(i) / bank.output_count()))) continue;
    const wisp::Output& output = model().outputs[i % bank.output_count()];
    const double room = 0.5 * (output.highest - output.lowest);
    // What goes out shrinks to 0.
    if (!(values[i] >= std::min(0.0f, static_cast<float>(output.lowest - room)))) std::abort();
    if (!(values[i] <= std::max(0.0f, static_cast<float>(output.highest + room)))) std::abort();
  }
}

// Saves, damages a few bytes, mends the hash half of the time, and restores.
void restore_damaged(wisp::Bank& bank, Source& source) {
  std::vector<std::byte> bytes(bank.save_bytes());
  bank.save(bytes);
  const int damages = source.take<std::uint8_t>() % 4;
  for (int k = 0; k < damages; ++k) {
    bytes[source.take<std::uint16_t>() % bytes.size()] = static_cast<std::byte>(source.take<std::uint8_t>());
  }
  if (source.take<std::uint8_t>() % 2 == 0) {
    const std::uint64_t hash = wisp::hash_bytes(std::span(bytes).subspan(32));
    std::memcpy(&bytes[24], &hash, sizeof hash);
  }
  const auto outcome = bank.restore(bytes);
  if (damages == 0 && !outcome) std::abort();
}

void act(wisp::Bank& bank, Source& source) {
  const wisp::InstanceId id{source.take<std::uint8_t>() % 12U, source.take<std::uint8_t>()};
  const wisp::InstanceId living = bank.at(static_cast<int>(id.slot));
  const auto input = source.take<float>();
  switch (source.take<std::uint8_t>() % 11) {
    case 0:
      bank.spawn(source.take<std::uint64_t>());
      break;
    case 1:
      bank.end(id.generation % 2 ? id : living);
      break;
    case 2:
      bank.set_inputs(living, std::span(&input, 1));
      break;
    case 3:
      bank.set_common_inputs(std::span(&input, 1));
      break;
    case 4:
      bank.step();
      break;
    case 5:
      bank.advance(std::chrono::nanoseconds(source.take<std::int64_t>() % 1'000'000'000));
      break;
    case 6:
      bank.set_noise(input);
      break;
    case 7:
      restore_damaged(bank, source);
      break;
    case 8:
      if (auto* extinction = bank.extinction()) extinction->relight(living);
      break;
    case 9:
      if (auto* extinction = bank.extinction()) extinction->extinguish(living);
      break;
    default:
      bank.reset(living);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Source source(data, size);
  auto bank = wisp::Bank::create(model(), {.capacity = 1 + source.take<std::uint8_t>() % 10});
  if (!bank) std::abort();
  bank->spawn();
  while (!source.empty()) {
    act(*bank, source);
    expect_in_range(*bank);
  }
  return 0;
}
