#pragma once
// What only a bank of things that go out has (Bank::extinction()): instances whose wind the model's rule
// (wisp/model/extinction.hpp) finds too strong go out in a step and stay out, whatever the wind does then; their
// outputs shrink to 0 and are 0 until they are lit again. Their random streams go on.

#include <chrono>
#include <optional>
#include <span>

#include "wisp/run/bank.hpp"

namespace wisp {

/// The age of what never happened.
inline constexpr std::chrono::nanoseconds kNever = std::chrono::nanoseconds::max();

/// Whether an instance burns, and how that shows. Ages are of what is shown, in time that passed through steps; a
/// drawing makes smoke and ember of them.
struct LitState {
  bool lit = true;
  float size = 1;  ///< of what is seen, 0 … 1; outputs and polylines are already multiplied by it
  std::chrono::nanoseconds since_lit = kNever;  ///< since it was last lit again; one that was spawned lit was not
  std::chrono::nanoseconds since_out = kNever;  ///< since it last went out
  bool relit = false;                           ///< in the last call of step() or advance(), or by hand since
  bool went_out = false;                        ///< likewise
};

/// Going out and being lit again. It lives as long as the bank, and moves with it; it allocates nothing.
class ExtinctionFacet {
 public:
  /// Whether an instance burns; nothing when `id` is not valid.
  std::optional<LitState> state_of(InstanceId id) const;

  /// The same of all: at least Bank::slots() values; what is in an empty slot does not burn and never did.
  void states(std::span<LitState> states) const;

  /// Lights an instance that is out: it starts at the model's operating point, unharmed, and grows from the size that
  /// is left of it. One that burns goes on. Returns false when `id` is not valid.
  bool relight(InstanceId id);

  /// Puts an instance out, whatever the wind. One that is out stays so. Returns false when `id` is not valid.
  bool extinguish(InstanceId id);

 private:
  friend struct Bank::State;  // makes it
  explicit ExtinctionFacet(Bank::State& state) : state_(&state) {}
  ExtinctionFacet(const ExtinctionFacet&) = delete;
  ExtinctionFacet& operator=(const ExtinctionFacet&) = delete;

  Bank::State* state_;
};

}  // namespace wisp
