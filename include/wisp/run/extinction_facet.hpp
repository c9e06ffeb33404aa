#pragma once
// Extinction in a bank (Bank::extinction()): when the model's rule (wisp/model/extinction.hpp) finds the wind too
// strong, an instance is extinguished and stays so, whatever the wind does then; its outputs shrink to 0 and stay 0
// until it is relit. Its random stream continues.

#include <chrono>
#include <optional>
#include <span>

#include "wisp/run/bank.hpp"

namespace wisp {

/// Age of an event that never happened.
inline constexpr std::chrono::nanoseconds kNever = std::chrono::nanoseconds::max();

/// Burning and appearance of an instance. Ages are those of the displayed state, in the bank's time, which only step()
/// and advance() advance; a renderer derives smoke and ember from them.
struct LitState {
  bool lit = true;
  float size = 1;  ///< apparent size, 0 … 1; outputs and polylines are already multiplied by it
  std::chrono::nanoseconds since_lit = kNever;  ///< time since the last relighting; kNever if none since spawn or reset
  std::chrono::nanoseconds since_out = kNever;  ///< time since the last extinction; kNever if none since spawn or reset
  bool relit = false;                           ///< relit since the last call of step() or advance()
  bool went_out = false;                        ///< extinguished in the last call of step() or advance(), or since
};

/// Access to extinction and relighting. It lives as long as the bank, and moves with it. No function allocates.
class ExtinctionFacet {
 public:
  /// Returns the state of an instance; nothing when `id` is not valid.
  std::optional<LitState> state_of(InstanceId id) const;

  /// Reads the states of all instances: at least Bank::slots() values; an empty slot does not burn and never did.
  void states(std::span<LitState> states) const;

  /// Lights an extinguished instance, undamaged: its remaining size and shape blend into a recorded re-ignition, then
  /// into dynamics restarted at the operating point. No effect on a burning one. Returns false when `id` is not valid.
  bool relight(InstanceId id);

  /// Extinguishes an instance, whatever the wind, if it burns. Returns false when `id` is not valid.
  bool extinguish(InstanceId id);

 private:
  friend struct Bank::State;  // makes it
  explicit ExtinctionFacet(Bank::State& state) : state_(&state) {}
  ExtinctionFacet(const ExtinctionFacet&) = delete;
  ExtinctionFacet& operator=(const ExtinctionFacet&) = delete;

  Bank::State* state_;
};

}  // namespace wisp
