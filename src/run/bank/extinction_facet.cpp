#include "wisp/run/extinction_facet.hpp"

#include <algorithm>

#include "run/bank/bank_state.hpp"

namespace wisp {

std::optional<LitState> ExtinctionFacet::state_of(InstanceId id) const {
  if (!state_->valid(id)) return {};
  return state_->lit_state(static_cast<int>(id.slot));
}

void ExtinctionFacet::states(std::span<LitState> states) const {
  const Bank::State& s = *state_;
  const LitState none{.lit = false, .size = 0.0F};
  if (!check_size("ExtinctionFacet::states()", states.size(), static_cast<std::size_t>(s.rows), true)) return;
  for (int slot = 0; slot < s.rows; ++slot) states[slot] = s.alive[slot] ? s.lit_state(slot) : none;
  std::fill(states.begin() + s.rows, states.end(), none);
}

bool ExtinctionFacet::relight(InstanceId id) {
  if (!state_->valid(id)) return false;
  state_->relight(static_cast<int>(id.slot));
  return true;
}

bool ExtinctionFacet::extinguish(InstanceId id) {
  if (!state_->valid(id)) return false;
  state_->extinguish(static_cast<int>(id.slot));
  return true;
}

}  // namespace wisp
