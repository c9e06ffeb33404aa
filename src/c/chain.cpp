// Instances of a chain: their segment, placing, steering and ground.

#include <array>
#include <chrono>
#include <cmath>
#include <type_traits>

#include "c/boundary.hpp"
#include "c/handles.hpp"
#include "wisp/run/chain_facet.hpp"

namespace {

using namespace wisp::c;

// Calls use(chain) with the bank's chain (const for a const bank); what it returns, if anything, is the outcome.
template <class Handle, class Use>
wisp_status on_chain(const char* function, Handle* bank, Use use) {
  if (!bank) return null_argument(function);
  auto* chain = bank->bank.chain();
  if (!chain) return fail(WISP_BAD_ARGUMENT, "%s: the model's dynamics are not a chain", function);
  if constexpr (std::is_void_v<decltype(use(*chain))>) {
    use(*chain);
    return WISP_OK;
  } else {
    return use(*chain);
  }
}

}  // namespace

extern "C" {

wisp_status wisp_bank_get_chain_place(const wisp_bank* bank, wisp_instance instance, wisp_chain_place* place) {
  if (!bank || !place) return null_argument(__func__);
  const char* const call = __func__;  // within a lambda __func__ is operator()
  if (!size_is_right(call, place->size)) return WISP_BAD_ARGUMENT;
  return on_chain(call, bank, [&](const wisp::ChainFacet& chain) {
    const auto found = chain.place_of(id_of(instance));
    if (!found) return not_alive(call);
    hand_out(wisp_chain_place{sizeof(wisp_chain_place), found->segment, found->step, found->mode}, place);
    return wisp_status{WISP_OK};
  });
}

wisp_status wisp_bank_place(wisp_bank* bank, wisp_instance instance, const wisp_body* body) {
  if (!bank || !body) return null_argument(__func__);
  const char* const call = __func__;
  if (!size_is_right(call, body->size)) return WISP_BAD_ARGUMENT;
  return on_chain(call, bank, [&](wisp::ChainFacet& chain) {
    if (!bank->bank.valid(id_of(instance))) return not_alive(call);
    wisp_body known{};
    known.orientation[0] = 1;
    take_in(body, known);
    const wisp::BodyMoment moment{std::to_array(known.position), std::to_array(known.orientation),
                                  std::to_array(known.velocity), std::to_array(known.spin)};
    if (chain.place(id_of(instance), moment)) return wisp_status{WISP_OK};
    return fail(WISP_BAD_ARGUMENT, "%s was given a number that is not finite", call);
  });
}

wisp_status wisp_bank_steer(wisp_bank* bank, wisp_instance instance, const wisp_target* target) {
  if (!bank || !target) return null_argument(__func__);
  const char* const call = __func__;
  if (!size_is_right(call, target->size)) return WISP_BAD_ARGUMENT;
  return on_chain(call, bank, [&](wisp::ChainFacet& chain) {
    if (!bank->bank.valid(id_of(instance))) return not_alive(call);
    wisp_target known{};
    take_in(target, known);
    wisp::SteerTarget wanted{std::to_array(known.position), std::chrono::nanoseconds(known.nanoseconds)};
    if (known.within != 0) wanted.near = known.within;
    if (chain.steer(id_of(instance), wanted)) return wisp_status{WISP_OK};
    if (!chain.can_steer()) return fail(WISP_BAD_ARGUMENT, "%s: this chain cannot be steered", call);
    return fail(WISP_BAD_ARGUMENT, "%s was given a place, a time or a nearness that is out of its range", call);
  });
}

wisp_status wisp_bank_release(wisp_bank* bank, wisp_instance instance) {
  const char* const call = __func__;
  return on_chain(call, bank, [&](wisp::ChainFacet& chain) {
    return chain.release(id_of(instance)) ? wisp_status{WISP_OK} : not_alive(call);
  });
}

int32_t wisp_bank_can_steer(const wisp_bank* bank) {
  const wisp::ChainFacet* chain = bank ? bank->bank.chain() : nullptr;
  return chain && chain->can_steer() ? 1 : 0;
}

wisp_status wisp_bank_set_ground(wisp_bank* bank, float height) {
  if (bank && !std::isfinite(height)) {
    return fail(WISP_BAD_ARGUMENT, "%s was given a height that is not finite", __func__);
  }
  return on_chain(__func__, bank, [&](wisp::ChainFacet& chain) { chain.set_ground(height); });
}

wisp_status wisp_bank_clear_ground(wisp_bank* bank) {
  return on_chain(__func__, bank, [](wisp::ChainFacet& chain) { chain.set_ground({}); });
}

wisp_status wisp_bank_get_chain_settings(const wisp_bank* bank, wisp_chain_settings* settings) {
  if (!bank || !settings) return null_argument(__func__);
  if (!size_is_right(__func__, settings->size)) return WISP_BAD_ARGUMENT;
  return on_chain(__func__, bank, [&](const wisp::ChainFacet& chain) {
    const auto ground = chain.ground();
    wisp_chain_settings filled{};
    filled.has_ground = ground ? 1 : 0;
    filled.ground = ground.value_or(0.0f);
    hand_out(filled, settings);
  });
}
}
