// C interface of banks: stepping, outputs, outlines, rings, extinction, saved state, and the control of chains.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>

#include "c/boundary.hpp"
#include "wisp/run/body_facet.hpp"
#include "wisp/run/chain_facet.hpp"
#include "wisp/run/extinction_facet.hpp"

namespace {

using namespace wisp::c;
using wisp::InstanceId;

constexpr std::uint32_t kMaxSteps = 1U << 24, kMaxParts = 4096;

std::size_t rows(const wisp_bank* bank, int columns) {
  return static_cast<std::size_t>(bank->bank.slots()) * static_cast<std::size_t>(columns);
}

// Copies the option fields that the caller knows over the defaults.
std::optional<wisp::BankOptions> options_of(const char* function, const wisp_bank_options* given) {
  wisp_bank_options known = wisp_bank_default_options();
  if (given) {
    if (!size_is_right(function, given->size)) return {};
    take_in(given, known);
  }
  const auto whole = [](std::uint32_t value, int zero) {
    return value == 0 ? zero : static_cast<int>(std::min<std::uint32_t>(value, 0x7fffffff));
  };
  wisp::BankOptions options{.capacity = whole(known.capacity, 1), .seed = known.seed};
  options.polyline_points = whole(known.polyline_points, options.polyline_points);
  if (known.longest > 0) options.longest_advance = std::chrono::milliseconds(known.longest);
  if (known.memory) options.memory = {static_cast<std::byte*>(known.memory), known.memory_size};
  return options;
}

wisp_status handed_out(const char* function, InstanceId id, wisp_instance* instance) {
  if (id.generation == 0) return fail(WISP_NO_INSTANCE_LEFT, "%s: the bank is full", function);
  *instance = instance_of(id);
  return WISP_OK;
}

bool has_outline(const char* function, const wisp_bank* bank) {
  if (bank->bank.polyline_points() > 0) return true;
  fail(WISP_BAD_ARGUMENT, "%s: the model's outputs are not an outline", function);
  return false;
}

// Returns an instance's flame state, nothing if it is not alive. Without a rule of extinction an instance always burns.
std::optional<wisp::LitState> state_of(const wisp_bank* bank, InstanceId id) {
  if (const wisp::ExtinctionFacet* extinction = bank->bank.extinction()) return extinction->state_of(id);
  return bank->bank.valid(id) ? std::optional<wisp::LitState>(wisp::LitState{}) : std::nullopt;
}

// Calls use(facet) on the result of facet_of(bank), or reports what the model lacks. `use` returns nothing (success), a
// status, or false if the instance is not alive.
template <class Handle, class FacetOf, class Use>
wisp_status on_facet(const char* function, Handle* bank, const char* lacks, FacetOf facet_of, Use use) {
  if (!bank) return null_argument(function);
  auto* facet = facet_of(bank->bank);
  using Outcome = decltype(use(*facet));
  if (!facet) return fail(WISP_BAD_ARGUMENT, "%s: the model%s", function, lacks);
  if constexpr (std::is_void_v<Outcome>) {
    use(*facet);
    return WISP_OK;
  } else if constexpr (std::is_same_v<Outcome, bool>) {
    return use(*facet) ? wisp_status{WISP_OK} : not_alive(function);
  } else {
    return use(*facet);
  }
}

template <class Handle, class Use>
wisp_status on_chain(const char* function, Handle* bank, Use use) {
  return on_facet(
      function, bank, "'s dynamics are not a chain", [](auto& living) { return living.chain(); }, use);
}

template <class Use>
wisp_status on_extinction(const char* function, wisp_bank* bank, Use use) {
  return on_facet(
      function, bank, " has no rule of extinction", [](auto& living) { return living.extinction(); }, use);
}

template <class Handle, class Use>
wisp_status on_body(const char* function, Handle* bank, Use use) {
  return on_facet(
      function, bank, " is not in the round", [](auto& living) { return living.body(); }, use);
}

constexpr const char* kNoSurface =
    "%s: expected 2 rings or more of 3 to 256 segments, a stride of 6 or more, and room for all";

}  // namespace

extern "C" {

wisp_bank_options wisp_bank_default_options(void) {
  const wisp::BankOptions defaults;
  return {.size = sizeof(wisp_bank_options),
          .capacity = static_cast<uint32_t>(defaults.capacity),
          .polyline_points = static_cast<uint32_t>(defaults.polyline_points),
          .seed = defaults.seed};
}

wisp_status wisp_bank_bytes(const wisp_model* model, const wisp_bank_options* options, size_t* bytes) {
  if (!model || !bytes) return null_argument(__func__);
  const auto known = options_of(__func__, options);
  if (!known) return WISP_BAD_ARGUMENT;
  return guarded(__func__, [&]() -> wisp_status {
    const auto needed = wisp::bank_bytes(model->model, *known);
    if (!needed) return fail(WISP_BAD_ARGUMENT, needed.error());
    *bytes = *needed;
    return WISP_OK;
  });
}

wisp_status wisp_bank_create(const wisp_model* model, const wisp_bank_options* options, wisp_bank** bank) {
  if (!model || !bank) return null_argument(__func__);
  const auto known = options_of(__func__, options);
  if (!known) return WISP_BAD_ARGUMENT;
  return guarded(__func__, [&]() -> wisp_status {
    if (const auto needed = wisp::bank_bytes(model->model, *known); !needed) {
      return fail(WISP_BAD_ARGUMENT, needed.error());
    }
    auto made = wisp::Bank::create(model->model, *known);
    if (!made) return fail(known->memory.data() ? WISP_BAD_ARGUMENT : WISP_NO_MEMORY, made.error());
    *bank = new wisp_bank{std::move(made).value()};
    return WISP_OK;
  });
}

void wisp_bank_free(wisp_bank* bank) { delete bank; }

wisp_status wisp_bank_get_facts(const wisp_bank* bank, wisp_bank_facts* facts) {
  if (!struct_is_right(__func__, bank, facts)) return WISP_BAD_ARGUMENT;
  const wisp::Bank& b = bank->bank;
  return hand_out(wisp_bank_facts{.capacity = static_cast<uint32_t>(b.capacity()),
                                  .alive = static_cast<uint32_t>(b.size()),
                                  .slots = static_cast<uint32_t>(b.slots()),
                                  .inputs = static_cast<uint32_t>(b.input_count()),
                                  .outputs = static_cast<uint32_t>(b.output_count()),
                                  .polyline_points = static_cast<uint32_t>(b.polyline_points()),
                                  .clamped = b.clamped().clamped,
                                  .steps = b.clamped().steps},
                  facts);
}

wisp_status wisp_bank_spawn(wisp_bank* bank, wisp_instance* instance) {
  if (!bank || !instance) return null_argument(__func__);
  return handed_out(__func__, bank->bank.spawn(), instance);
}

wisp_status wisp_bank_spawn_stream(wisp_bank* bank, uint64_t stream, wisp_instance* instance) {
  if (!bank || !instance) return null_argument(__func__);
  return handed_out(__func__, bank->bank.spawn(stream), instance);
}

wisp_status wisp_bank_end(wisp_bank* bank, wisp_instance instance) {
  if (!bank) return null_argument(__func__);
  return bank->bank.end(id_of(instance)) ? WISP_OK : not_alive(__func__);
}

int32_t wisp_bank_alive(const wisp_bank* bank, wisp_instance instance) {
  return bank && bank->bank.valid(id_of(instance)) ? 1 : 0;
}

wisp_instance wisp_bank_at(const wisp_bank* bank, uint32_t slot) {
  if (!bank || slot > 0x7fffffff) return WISP_NO_INSTANCE;
  return instance_of(bank->bank.at(static_cast<int>(slot)));
}

wisp_status wisp_bank_set_inputs(wisp_bank* bank, const float* values, size_t count) {
  if (!bank) return null_argument(__func__);
  if (!buffer_is_right(__func__, values, count, rows(bank, bank->bank.input_count()), true)) return WISP_BAD_ARGUMENT;
  bank->bank.set_inputs({values, count});
  return WISP_OK;
}

wisp_status wisp_bank_set_common_inputs(wisp_bank* bank, const float* values, size_t count) {
  if (!bank) return null_argument(__func__);
  if (!buffer_is_right(__func__, values, count, bank->bank.input_count())) return WISP_BAD_ARGUMENT;
  bank->bank.set_common_inputs({values, count});
  return WISP_OK;
}

wisp_status wisp_bank_set_instance_inputs(wisp_bank* bank, wisp_instance instance, const float* values, size_t count) {
  if (!bank) return null_argument(__func__);
  if (!buffer_is_right(__func__, values, count, bank->bank.input_count())) return WISP_BAD_ARGUMENT;
  return bank->bank.set_inputs(id_of(instance), {values, count}) ? WISP_OK : not_alive(__func__);
}

wisp_status wisp_bank_set_noise(wisp_bank* bank, float scale) {
  if (!bank) return null_argument(__func__);
  bank->bank.set_noise(scale);
  return WISP_OK;
}

wisp_status wisp_bank_get_noise(const wisp_bank* bank, float* scale) {
  if (!bank || !scale) return null_argument(__func__);
  *scale = bank->bank.noise();
  return WISP_OK;
}

wisp_status wisp_bank_step(wisp_bank* bank) {
  if (!bank) return null_argument(__func__);
  bank->bank.step();
  return WISP_OK;
}

wisp_status wisp_bank_advance(wisp_bank* bank, int64_t nanoseconds, int32_t* steps) {
  if (!bank) return null_argument(__func__);
  const int made = bank->bank.advance(std::chrono::nanoseconds(nanoseconds));
  if (steps) *steps = made;
  return WISP_OK;
}

wisp_status wisp_bank_advance_seconds(wisp_bank* bank, double seconds, int32_t* steps) {
  if (!bank) return null_argument(__func__);
  const int made = bank->bank.advance(seconds);
  if (steps) *steps = made;
  return WISP_OK;
}

wisp_status wisp_bank_step_many(wisp_bank* bank, uint32_t steps, const float* inputs, size_t input_count,
                                float* outputs, size_t output_count) {
  if (!bank) return null_argument(__func__);
  if (steps > kMaxSteps) return fail(WISP_BAD_ARGUMENT, "%s was asked for more than 2^24 steps", __func__);
  const size_t in = inputs ? steps * rows(bank, bank->bank.input_count()) : 0;
  const size_t out = outputs ? steps * rows(bank, bank->bank.output_count()) : 0;
  if (!buffer_is_right(__func__, inputs, input_count, in)) return WISP_BAD_ARGUMENT;
  if (!buffer_is_right(__func__, outputs, output_count, out)) return WISP_BAD_ARGUMENT;
  bank->bank.step(static_cast<int>(steps), {inputs, in}, {outputs, out});
  return WISP_OK;
}

wisp_status wisp_bank_set_crew(wisp_bank* bank, uint32_t parts, wisp_crew_run run, void* pool) {
  if (!bank) return null_argument(__func__);
  if (parts < 1 || parts > kMaxParts) return fail(WISP_BAD_ARGUMENT, "%s: parts are 1 to 4096", __func__);
  bank->bank.set_crew({.parts = static_cast<int>(parts), .run = run, .pool = pool});
  return WISP_OK;
}

wisp_status wisp_bank_outputs(const wisp_bank* bank, float* values, size_t count) {
  if (!bank) return null_argument(__func__);
  if (!buffer_is_right(__func__, values, count, rows(bank, bank->bank.output_count()), true)) return WISP_BAD_ARGUMENT;
  bank->bank.outputs({values, count});
  return WISP_OK;
}

wisp_status wisp_bank_instance_outputs(const wisp_bank* bank, wisp_instance instance, float* values, size_t count) {
  if (!bank) return null_argument(__func__);
  if (!buffer_is_right(__func__, values, count, bank->bank.output_count())) return WISP_BAD_ARGUMENT;
  return bank->bank.outputs(id_of(instance), {values, count}) ? WISP_OK : not_alive(__func__);
}

wisp_status wisp_bank_polylines(const wisp_bank* bank, float* values, size_t count) {
  if (!bank) return null_argument(__func__);
  if (!has_outline(__func__, bank)) return WISP_BAD_ARGUMENT;
  const size_t expected = rows(bank, 2 * bank->bank.polyline_points());
  if (!buffer_is_right(__func__, values, count, expected, true)) return WISP_BAD_ARGUMENT;
  bank->bank.polylines({values, count});
  return WISP_OK;
}

wisp_status wisp_bank_polyline(const wisp_bank* bank, wisp_instance instance, float* values, size_t count) {
  if (!bank) return null_argument(__func__);
  if (!has_outline(__func__, bank)) return WISP_BAD_ARGUMENT;
  if (!buffer_is_right(__func__, values, count, 2 * bank->bank.polyline_points())) return WISP_BAD_ARGUMENT;
  return bank->bank.polyline(id_of(instance), {values, count}) ? WISP_OK : not_alive(__func__);
}

wisp_status wisp_bank_look(wisp_bank* bank, float right_x, float right_z) {
  if (!(std::abs(std::hypot(right_x, right_z) - 1) < 0.01F)) {
    return fail(WISP_BAD_ARGUMENT, "%s was given (%f, %f), expected a unit vector", __func__,
                static_cast<double>(right_x), static_cast<double>(right_z));
  }
  return on_body(__func__, bank, [&](wisp::BodyFacet& body) { body.look(right_x, right_z); });
}

wisp_status wisp_bank_rings(const wisp_bank* bank, wisp_instance instance, float* values, size_t count) {
  const char* const call = __func__;
  return on_body(call, bank, [&](const wisp::BodyFacet& body) {
    const std::size_t expected = static_cast<std::size_t>(body.rings()) * wisp::kRingNumbers;
    if (!buffer_is_right(call, values, count, expected)) return wisp_status{WISP_BAD_ARGUMENT};
    return body.read_rings(id_of(instance), {values, count}) ? wisp_status{WISP_OK} : not_alive(call);
  });
}

wisp_status wisp_ring_mesh(const float* rings, uint32_t count, uint32_t segments, float* numbers, size_t room,
                           size_t stride) {
  if (!rings || !numbers) return null_argument(__func__);
  const std::span all(rings, count * wisp::kRingNumbers);
  const bool fine = wisp::ring_mesh(all, static_cast<int>(segments), {numbers, room}, stride);
  return fine ? WISP_OK : fail(WISP_BAD_ARGUMENT, kNoSurface, __func__);
}

wisp_status wisp_ring_triangles(uint32_t rings, uint32_t segments, uint32_t* indices, size_t count) {
  if (!indices) return null_argument(__func__);
  const bool fine = wisp::ring_triangles(static_cast<int>(rings), static_cast<int>(segments), {indices, count});
  return fine ? WISP_OK : fail(WISP_BAD_ARGUMENT, kNoSurface, __func__);
}

wisp_status wisp_bank_get_flame_state(const wisp_bank* bank, wisp_instance instance, wisp_flame_state* state) {
  if (!struct_is_right(__func__, bank, state)) return WISP_BAD_ARGUMENT;
  const auto found = state_of(bank, id_of(instance));
  if (!found) return not_alive(__func__);
  const wisp::FlameLight light = bank->bank.light(id_of(instance)).value_or(wisp::FlameLight{});
  return hand_out(wisp_flame_state{.lit = found->lit ? 1U : 0U,
                                   .flame_size = found->size,
                                   .events = (found->went_out ? WISP_WENT_OUT : 0) | (found->relit ? WISP_RELIT : 0),
                                   .since_lit = found->since_lit.count(),
                                   .since_out = found->since_out.count(),
                                   .light = {light.position[0], light.position[1], light.position[2]},
                                   .intensity = light.intensity,
                                   .kelvin = light.kelvin},
                  state);
}

wisp_status wisp_bank_flame_sizes(const wisp_bank* bank, float* values, size_t count) {
  if (!bank) return null_argument(__func__);
  if (!buffer_is_right(__func__, values, count, rows(bank, 1), true)) return WISP_BAD_ARGUMENT;
  for (int slot = 0; slot < bank->bank.slots(); ++slot) {
    const auto found = state_of(bank, bank->bank.at(slot));
    values[slot] = found ? found->size : 0.0f;
  }
  std::fill(values + bank->bank.slots(), values + count, 0.0f);
  return WISP_OK;
}

wisp_status wisp_bank_relight(wisp_bank* bank, wisp_instance instance) {
  return on_extinction(__func__, bank, [&](auto& extinction) { return extinction.relight(id_of(instance)); });
}

wisp_status wisp_bank_extinguish(wisp_bank* bank, wisp_instance instance) {
  return on_extinction(__func__, bank, [&](auto& extinction) { return extinction.extinguish(id_of(instance)); });
}

wisp_status wisp_bank_reset_instance(wisp_bank* bank, wisp_instance instance) {
  if (!bank) return null_argument(__func__);
  return bank->bank.reset(id_of(instance)) ? WISP_OK : not_alive(__func__);
}

wisp_status wisp_bank_reset(wisp_bank* bank) {
  if (!bank) return null_argument(__func__);
  bank->bank.reset();
  return WISP_OK;
}

wisp_status wisp_bank_save_bytes(const wisp_bank* bank, size_t* bytes) {
  if (!bank || !bytes) return null_argument(__func__);
  *bytes = bank->bank.save_bytes();
  return WISP_OK;
}

wisp_status wisp_bank_save(const wisp_bank* bank, void* bytes, size_t size) {
  if (!bank) return null_argument(__func__);
  if (!buffer_is_right(__func__, bytes, size, bank->bank.save_bytes())) return WISP_BAD_ARGUMENT;
  bank->bank.save({static_cast<std::byte*>(bytes), size});
  return WISP_OK;
}

wisp_status wisp_bank_restore(wisp_bank* bank, const void* bytes, size_t size) {
  if (!bank || !bytes) return null_argument(__func__);
  return guarded(__func__, [&]() -> wisp_status {
    const auto outcome = bank->bank.restore({static_cast<const std::byte*>(bytes), size});
    return outcome ? static_cast<wisp_status>(WISP_OK) : fail(WISP_BAD_DATA, outcome.error());
  });
}

wisp_status wisp_bank_get_chain_place(const wisp_bank* bank, wisp_instance instance, wisp_chain_place* place) {
  const char* const call = __func__;  // within a lambda __func__ is operator()
  if (!struct_is_right(call, bank, place)) return WISP_BAD_ARGUMENT;
  return on_chain(call, bank, [&](const wisp::ChainFacet& chain) {
    const auto found = chain.place_of(id_of(instance));
    if (!found) return not_alive(call);
    const auto& [segment, step, mode, v, w, lies, landed] = *found;
    return hand_out(wisp_chain_place{0, segment, step, mode, {v[0], v[1], v[2]}, {w[0], w[1], w[2]}, lies, landed},
                    place);
  });
}

wisp_status wisp_bank_place(wisp_bank* bank, wisp_instance instance, const wisp_body* body) {
  const char* const call = __func__;
  if (!struct_is_right(call, bank, body)) return WISP_BAD_ARGUMENT;
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
  const char* const call = __func__;
  if (!struct_is_right(call, bank, target)) return WISP_BAD_ARGUMENT;
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
  return on_chain(__func__, bank, [&](wisp::ChainFacet& chain) { return chain.release(id_of(instance)); });
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
  if (!struct_is_right(__func__, bank, settings)) return WISP_BAD_ARGUMENT;
  return on_chain(__func__, bank, [&](const wisp::ChainFacet& chain) {
    const auto ground = chain.ground();
    hand_out(wisp_chain_settings{.has_ground = ground ? 1U : 0U, .ground = ground.value_or(0.0f)}, settings);
  });
}

}  // extern "C"
