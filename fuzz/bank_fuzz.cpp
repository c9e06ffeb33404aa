// Calls a bank of any kind in any order, with any arguments and with damaged saved states. Afterwards the outputs are
// finite and bounded, and a second bank that restores the state plays the same bits.

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "base/hash.hpp"
#include "fuzz/alive.hpp"
#include "fuzz/kinds.hpp"
#include "fuzz/source.hpp"
#include "wisp/run/chain_facet.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace {

using wisp::fuzz::Source;

// Saves, damages up to three places, corrects the hash in three of four cases, and restores. Returns whether damaged
// bytes were accepted.
bool restore_damaged(wisp::Bank& bank, Source& source) {
  std::vector<std::byte> bytes = wisp::fuzz::saved(bank);
  const int damages = source.take<std::uint8_t>() % 4;
  for (int k = 0; k < damages; ++k) {
    const std::size_t at = source.take<std::uint16_t>() % bytes.size();
    if (source.take<std::uint8_t>() % 2 == 0) {
      bytes[at] = static_cast<std::byte>(source.take<std::uint8_t>());
      continue;
    }
    const auto number = source.take<float>();
    std::memcpy(&bytes[std::min(at / 4 * 4, bytes.size() - 4)], &number, 4);
  }
  if (source.take<std::uint8_t>() % 4 != 0) {
    const std::uint64_t hash = wisp::hash_bytes(std::span(bytes).subspan(32));
    std::memcpy(&bytes[24], &hash, sizeof hash);
  }
  const auto outcome = bank.restore(bytes);
  if (damages == 0 && !outcome) std::abort();
  return damages > 0 && outcome;
}

void act_on_chain(wisp::ChainFacet& chain, wisp::InstanceId id, Source& source) {
  const auto number = source.take<float>();
  switch (source.take<std::uint8_t>() % 6) {
    case 0: {
      wisp::BodyMoment body;
      for (auto* part : {&body.position, &body.velocity, &body.spin}) {
        for (float& x : *part) x = source.take<float>();
      }
      for (float& x : body.orientation) x = source.take<float>();
      chain.place(id, body);
      break;
    }
    case 1:
      chain.steer(id, {{number, source.take<float>(), source.take<float>()},
                       std::chrono::nanoseconds(source.take<std::int64_t>()),
                       source.take<float>()});
      break;
    case 2:
      chain.set_ground(number);
      break;
    case 3:
      chain.set_ground({});
      break;
    default:
      chain.release(id);
  }
}

// Returns whether the bank accepted a damaged state.
bool act(wisp::Bank& bank, const wisp::Model& model, Source& source) {
  const wisp::InstanceId id{source.take<std::uint8_t>() % 12U, source.take<std::uint8_t>()};
  const wisp::InstanceId living = bank.at(static_cast<int>(id.slot));
  std::vector<float> inputs(model.inputs.size());
  for (float& input : inputs) input = source.take<float>();
  switch (source.take<std::uint8_t>() % 12) {
    case 0:
      bank.spawn(source.take<std::uint64_t>());
      break;
    case 1:
      bank.end(id.generation % 2 ? id : living);
      break;
    case 2:
      bank.set_inputs(living, inputs);
      break;
    case 3:
      bank.set_common_inputs(inputs);
      break;
    case 4:
      for (int k = source.take<std::uint8_t>() % 16; k >= 0; --k) bank.step();
      break;
    case 5:
      bank.advance(std::chrono::nanoseconds(source.take<std::int64_t>() % 1'000'000'000));
      break;
    case 6:
      bank.set_noise(source.take<float>());
      break;
    case 7:
      return restore_damaged(bank, source);
    case 8:
      if (auto* extinction = bank.extinction()) extinction->relight(living);
      break;
    case 9:
      if (auto* extinction = bank.extinction()) extinction->extinguish(living);
      break;
    case 10:
      if (auto* chain = bank.chain()) act_on_chain(*chain, living, source);
      break;
    default:
      bank.reset(living);
  }
  return false;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Source source(data, size);
  const auto& kinds = wisp::fuzz::kinds();
  const wisp::Model& model = kinds[source.take<std::uint8_t>() % kinds.size()];
  const int capacity = 1 + source.take<std::uint8_t>() % 10;
  auto bank = wisp::Bank::create(model, {.capacity = capacity});
  if (!bank) std::abort();
  bank->spawn();
  bool harmed = false;
  for (int acts = 0; !source.empty() && acts < 200; ++acts) {
    harmed |= act(*bank, model, source);
    wisp::fuzz::expect_bounded(*bank, model);
  }
  // A damaged state that was accepted may grow to values that restore() refuses.
  if (!harmed) wisp::fuzz::expect_twin(*bank, model, capacity, 4);
  return 0;
}
