#include "wisp/run/switched_facet.hpp"

#include "run/bank/bank_state.hpp"

namespace wisp {

std::optional<int> SwitchedFacet::mode_of(InstanceId id) const {
  if (!state_->valid(id)) return {};
  constexpr int kLanes = Bank::State::kLanes;
  return state_->switched_stepper()->mode(static_cast<int>(id.slot) / kLanes, static_cast<int>(id.slot) % kLanes);
}

}  // namespace wisp
