#pragma once
// What every bank keeps, whatever was done to it: its outputs are numbers within bounds, what it saves restores, and a
// bank that restored it lives the same life to the last bit.

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "wisp/run/bank.hpp"

namespace wisp::fuzz {

inline std::vector<float> outputs_of(const Bank& bank) {
  std::vector<float> values(static_cast<std::size_t>(bank.slots()) * bank.output_count());
  bank.outputs(values);
  return values;
}

inline std::vector<std::byte> saved(const Bank& bank) {
  std::vector<std::byte> bytes(bank.save_bytes());
  bank.save(bytes);
  return bytes;
}

/// Positions of chains are held to a million metres, and come to rest at most as far beyond; other outputs stay within
/// their range and half of it more, or shrink to 0.
inline void expect_bounded(const Bank& bank, const Model& model) {
  const std::vector<float> values = outputs_of(bank);
  const bool chain = std::holds_alternative<ChainModel>(model.dynamics);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const Output& output = model.outputs[k % model.outputs.size()];
    const double room = 0.501 * (output.highest - output.lowest) + 1e-30;
    const double low = chain ? -2.1e6 : std::min(0.0, output.lowest - room);
    const double high = chain ? 2.1e6 : std::max(0.0, output.highest + room);
    if (!(values[k] >= static_cast<float>(low) && values[k] <= static_cast<float>(high))) std::abort();
  }
}

/// Orientations of a chain that was not restored from bytes made to harm are of unit length.
inline void expect_unit(const Bank& bank, const Model& model) {
  if (!std::holds_alternative<ChainModel>(model.dynamics) || model.outputs.size() != 7) return;
  const std::vector<float> values = outputs_of(bank);
  for (int slot = 0; slot < bank.slots(); ++slot) {
    if (!bank.valid(bank.at(slot))) continue;
    const float* q = values.data() + 7 * slot + 3;
    const float length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(std::abs(length - 1) < 0.02f)) std::abort();
  }
}

/// A twin that restores what the bank saved, steps as it does.
inline void expect_twin(Bank& bank, const Model& model, int capacity, int steps) {
  auto twin = Bank::create(model, {.capacity = capacity, .seed = 99});
  if (!twin || !twin->restore(saved(bank))) std::abort();
  for (int k = 0; k < steps; ++k) {
    bank.step();
    twin->step();
    const auto a = outputs_of(bank), b = outputs_of(*twin);
    if (a.size() != b.size() || (!a.empty() && std::memcmp(a.data(), b.data(), 4 * a.size()) != 0)) std::abort();
  }
  if (saved(bank) != saved(*twin)) std::abort();
}

}  // namespace wisp::fuzz
