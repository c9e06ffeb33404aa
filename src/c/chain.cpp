// Instances of a chain: their segment, placing, steering and ground.

#include <algorithm>
#include <cmath>

#include "c/boundary.hpp"
#include "c/handles.hpp"
#include "wisp/run/chain_facet.hpp"

namespace {

using namespace wisp::c;

// Returns the bank's chain (const for a const bank), or the error that it has none.
template <class Handle>
auto* chain_of(const char* function, Handle* bank) {
  auto* chain = bank->bank.chain();
  if (!chain) fail(WISP_BAD_ARGUMENT, "%s: the model's dynamics are not a chain", function);
  return chain;
}

bool is_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
}

}  // namespace

extern "C" {

wisp_status wisp_bank_get_chain_place(const wisp_bank* bank, wisp_instance instance, wisp_chain_place* place) {
  if (!bank || !place) return null_argument(__func__);
  if (!size_is_right(__func__, place->size)) return WISP_BAD_ARGUMENT;
  const wisp::ChainFacet* chain = chain_of(__func__, bank);
  if (!chain) return WISP_BAD_ARGUMENT;
  const auto found = chain->place_of(id_of(instance));
  if (!found) return not_alive(__func__);
  wisp_chain_place filled{};
  filled.segment = found->segment;
  filled.step = found->step;
  filled.mode = found->mode;
  hand_out(filled, place);
  return WISP_OK;
}

wisp_status wisp_bank_place(wisp_bank* bank, wisp_instance instance, const wisp_body* body) {
  if (!bank || !body) return null_argument(__func__);
  if (!size_is_right(__func__, body->size)) return WISP_BAD_ARGUMENT;
  wisp::ChainFacet* chain = chain_of(__func__, bank);
  if (!chain) return WISP_BAD_ARGUMENT;
  if (!bank->bank.valid(id_of(instance))) return not_alive(__func__);
  wisp_body known{};
  known.orientation[0] = 1;
  take_in(body, known);
  if (!is_finite(known.position) || !is_finite(known.orientation) || !is_finite(known.velocity) ||
      !is_finite(known.spin)) {
    return fail(WISP_BAD_ARGUMENT, "%s was given a number that is not finite", __func__);
  }
  wisp::BodyMoment moment;
  std::copy_n(known.position, 3, moment.position.begin());
  std::copy_n(known.orientation, 4, moment.orientation.begin());
  std::copy_n(known.velocity, 3, moment.velocity.begin());
  std::copy_n(known.spin, 3, moment.spin.begin());
  if (chain->place(id_of(instance), moment)) return WISP_OK;
  return fail(WISP_BAD_ARGUMENT, "%s: the body cannot be placed", __func__);
}

wisp_status wisp_bank_set_ground(wisp_bank* bank, float height) {
  if (!bank) return null_argument(__func__);
  if (!std::isfinite(height)) return fail(WISP_BAD_ARGUMENT, "%s was given a height that is not finite", __func__);
  wisp::ChainFacet* chain = chain_of(__func__, bank);
  if (!chain) return WISP_BAD_ARGUMENT;
  chain->set_ground(height);
  return WISP_OK;
}

wisp_status wisp_bank_clear_ground(wisp_bank* bank) {
  if (!bank) return null_argument(__func__);
  wisp::ChainFacet* chain = chain_of(__func__, bank);
  if (!chain) return WISP_BAD_ARGUMENT;
  chain->set_ground({});
  return WISP_OK;
}

wisp_status wisp_bank_get_chain_settings(const wisp_bank* bank, wisp_chain_settings* settings) {
  if (!bank || !settings) return null_argument(__func__);
  if (!size_is_right(__func__, settings->size)) return WISP_BAD_ARGUMENT;
  const wisp::ChainFacet* chain = chain_of(__func__, bank);
  if (!chain) return WISP_BAD_ARGUMENT;
  const auto ground = chain->ground();
  wisp_chain_settings filled{};
  filled.has_ground = ground ? 1 : 0;
  filled.ground = ground.value_or(0.0f);
  hand_out(filled, settings);
  return WISP_OK;
}
}
