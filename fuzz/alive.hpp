#pragma once
// Invariants of every bank after any sequence of calls: outputs are finite and bounded, a saved state can be restored,
// and a bank that restored it plays the same bits.

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

/// Aborts unless all outputs are bounded: chains by ±2.1e6 (positions are clamped to 1e6 metres, while settling on the
/// ground to 2e6), others by 0 and their range extended by half its width on either side (extinguished flames have 0).
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

/// Aborts unless a chain's quaternions have unit length. Does not hold after a state was restored from damaged bytes.
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

/// Aborts unless a second bank that restores the bank's state plays the same bits for `steps` steps.
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
