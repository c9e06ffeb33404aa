#include "wisp/wisp.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <new>
#include <optional>
#include <string>

#include "wisp/model/file.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/cost.hpp"

struct wisp_model {
  wisp::Model model;
  wisp::Cost cost;
};

struct wisp_bank {
  wisp::Bank bank;
};

namespace {

using wisp::InstanceId;

// Fixed room, so that even a failure on the frame path allocates nothing.
thread_local char last_error[512] = "";

wisp_status fail(wisp_status status, const char* message) {
  std::snprintf(last_error, sizeof last_error, "%s", message);
  return status;
}

wisp_status fail(wisp_status status, const wisp::Error& error) { return fail(status, error.message.c_str()); }

wisp_status null_argument(const char* function) {
  std::snprintf(last_error, sizeof last_error, "%s was given a null pointer", function);
  return WISP_BAD_ARGUMENT;
}

wisp_status not_alive(const char* function) {
  std::snprintf(last_error, sizeof last_error, "%s was given an instance that is not alive", function);
  return WISP_NOT_ALIVE;
}

// Whether a buffer is there and has the stated number of values; says what is wrong otherwise.
bool buffer_is_right(const char* function, const void* values, std::size_t found, std::size_t expected) {
  if (!values && expected > 0) {
    null_argument(function);
    return false;
  }
  if (found == expected) return true;
  std::snprintf(last_error, sizeof last_error, "%s was given room for %zu, expected %zu", function, found, expected);
  return false;
}

// Runs what may throw; nothing but the want of memory can.
template <class Work>
wisp_status guarded(const char* function, Work work) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    std::snprintf(last_error, sizeof last_error, "%s found no memory", function);
    return WISP_NO_MEMORY;
  } catch (...) {
    std::snprintf(last_error, sizeof last_error, "%s failed unexpectedly", function);
    return WISP_BAD_DATA;
  }
}

// A struct whose caller may know fewer fields, or more, than this build.
template <class Struct>
bool size_is_right(const char* function, const Struct* given) {
  if (given->size >= 2 * sizeof(std::uint32_t)) return true;
  std::snprintf(last_error, sizeof last_error, "%s was given a struct whose size field is %u: set it to sizeof",
                function, given->size);
  return false;
}

template <class Struct>
void hand_out(Struct filled, Struct* out) {
  filled.size = out->size;
  std::memcpy(out, &filled, std::min<std::size_t>(out->size, sizeof(Struct)));
}

InstanceId id_of(wisp_instance instance) {
  return {static_cast<std::uint32_t>(instance), static_cast<std::uint32_t>(instance >> 32)};
}

wisp_instance instance_of(InstanceId id) {
  if (id.generation == 0) return WISP_NO_INSTANCE;
  return static_cast<wisp_instance>(id.generation) << 32 | id.slot;
}

std::size_t rows(const wisp_bank* bank, int columns) {
  return static_cast<std::size_t>(bank->bank.slots()) * static_cast<std::size_t>(columns);
}

// What the caller knows of the options, over the defaults.
std::optional<wisp::BankOptions> options_of(const char* function, const wisp_bank_options* given) {
  wisp_bank_options known = wisp_bank_default_options();
  if (given) {
    if (!size_is_right(function, given)) return {};
    std::memcpy(&known, given, std::min<std::size_t>(given->size, sizeof known));
  }
  wisp::BankOptions options;
  options.capacity = static_cast<int>(std::min<std::uint32_t>(known.capacity, 0x7fffffff));
  options.polyline_points = static_cast<int>(std::min<std::uint32_t>(known.polyline_points, 0x7fffffff));
  if (known.capacity == 0) options.capacity = 1;
  if (known.polyline_points == 0) options.polyline_points = wisp::BankOptions().polyline_points;
  options.seed = known.seed;
  if (known.memory) options.memory = {static_cast<std::byte*>(known.memory), known.memory_size};
  return options;
}

template <class Channels>
wisp_status hand_out_channel(const char* function, const Channels& channels, std::uint32_t index, wisp_channel* out) {
  if (!size_is_right(function, out)) return WISP_BAD_ARGUMENT;
  if (index >= channels.size()) {
    std::snprintf(last_error, sizeof last_error, "%s was given index %u, expected less than %zu", function, index,
                  channels.size());
    return WISP_BAD_ARGUMENT;
  }
  const auto& channel = channels[index];
  wisp_channel filled{};
  filled.name = channel.name.c_str();
  filled.unit = channel.unit.c_str();
  filled.lowest = channel.lowest;
  filled.highest = channel.highest;
  hand_out(filled, out);
  return WISP_OK;
}

}  // namespace

extern "C" {

int32_t wisp_version(void) { return WISP_VERSION_MAJOR * 1000000 + WISP_VERSION_MINOR * 1000 + WISP_VERSION_PATCH; }

const char* wisp_last_error(void) { return last_error; }

wisp_status wisp_model_load(const void* bytes, size_t size, wisp_model** model) {
  if (!bytes || !model) return null_argument(__func__);
  return guarded(__func__, [&]() -> wisp_status {
    auto parsed = wisp::parse_model({static_cast<const std::byte*>(bytes), size}, "the model");
    if (!parsed) return fail(WISP_BAD_DATA, parsed.error());
    const auto cost = wisp::count_operations(*parsed);
    if (!cost) return fail(WISP_BAD_DATA, cost.error());
    *model = new wisp_model{std::move(parsed).value(), *cost};
    return WISP_OK;
  });
}

void wisp_model_free(wisp_model* model) { delete model; }

wisp_status wisp_model_get_facts(const wisp_model* model, wisp_model_facts* facts) {
  if (!model || !facts) return null_argument(__func__);
  if (!size_is_right(__func__, facts)) return WISP_BAD_ARGUMENT;
  const auto* outline = std::get_if<wisp::OutlineView>(&model->model.view);
  wisp_model_facts filled{};
  filled.inputs = static_cast<uint32_t>(model->model.inputs.size());
  filled.outputs = static_cast<uint32_t>(model->model.outputs.size());
  filled.control_points = outline ? filled.outputs / 2 : 0;
  filled.usable = model->model.provenance.usable.verdict ? 1 : 0;
  filled.rate_hz = model->model.rate_hz;
  filled.metres_per_unit = outline ? outline->metres_per_unit : 0;
  filled.step_nanoseconds = wisp::step_time(model->model).count();
  filled.multiply_adds_per_frame = model->cost.multiply_adds_per_frame;
  filled.operations_per_frame = model->cost.operations_per_frame;
  if (const auto& rule = model->model.extinction) {
    filled.blow_out_level = rule->level;
    filled.blow_out_seconds = rule->seconds;
  }
  hand_out(filled, facts);
  return WISP_OK;
}

wisp_status wisp_model_get_input(const wisp_model* model, uint32_t index, wisp_channel* channel) {
  if (!model || !channel) return null_argument(__func__);
  return hand_out_channel(__func__, model->model.inputs, index, channel);
}

wisp_status wisp_model_get_output(const wisp_model* model, uint32_t index, wisp_channel* channel) {
  if (!model || !channel) return null_argument(__func__);
  return hand_out_channel(__func__, model->model.outputs, index, channel);
}

const char* wisp_model_name(const wisp_model* model) { return model ? model->model.name.c_str() : ""; }

wisp_bank_options wisp_bank_default_options(void) {
  const wisp::BankOptions defaults;
  wisp_bank_options options{};
  options.size = sizeof options;
  options.capacity = static_cast<uint32_t>(defaults.capacity);
  options.polyline_points = static_cast<uint32_t>(defaults.polyline_points);
  options.seed = defaults.seed;
  return options;
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
    auto made = wisp::Bank::create(model->model, *known);
    if (!made) return fail(WISP_BAD_ARGUMENT, made.error());
    *bank = new wisp_bank{std::move(made).value()};
    return WISP_OK;
  });
}

void wisp_bank_free(wisp_bank* bank) { delete bank; }

wisp_status wisp_bank_get_facts(const wisp_bank* bank, wisp_bank_facts* facts) {
  if (!bank || !facts) return null_argument(__func__);
  if (!size_is_right(__func__, facts)) return WISP_BAD_ARGUMENT;
  const wisp::Bank& b = bank->bank;
  wisp_bank_facts filled{};
  filled.capacity = static_cast<uint32_t>(b.capacity());
  filled.alive = static_cast<uint32_t>(b.size());
  filled.slots = static_cast<uint32_t>(b.slots());
  filled.inputs = static_cast<uint32_t>(b.input_count());
  filled.outputs = static_cast<uint32_t>(b.output_count());
  filled.polyline_points = static_cast<uint32_t>(b.polyline_points());
  filled.held = b.held().held;
  filled.steps = b.held().steps;
  hand_out(filled, facts);
  return WISP_OK;
}

static wisp_status handed_out(const char* function, InstanceId id, wisp_instance* instance) {
  if (id.generation == 0) {
    std::snprintf(last_error, sizeof last_error, "%s: the bank is full", function);
    return WISP_NO_INSTANCE_LEFT;
  }
  *instance = instance_of(id);
  return WISP_OK;
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
  if (!buffer_is_right(__func__, values, count, rows(bank, bank->bank.input_count()))) return WISP_BAD_ARGUMENT;
  bank->bank.set_inputs({values, count});
  return WISP_OK;
}

wisp_status wisp_bank_set_common_inputs(wisp_bank* bank, const float* values, size_t count) {
  if (!bank) return null_argument(__func__);
  const auto expected = static_cast<size_t>(bank->bank.input_count());
  if (!buffer_is_right(__func__, values, count, expected)) return WISP_BAD_ARGUMENT;
  bank->bank.set_common_inputs({values, count});
  return WISP_OK;
}

wisp_status wisp_bank_set_instance_inputs(wisp_bank* bank, wisp_instance instance, const float* values, size_t count) {
  if (!bank) return null_argument(__func__);
  const auto expected = static_cast<size_t>(bank->bank.input_count());
  if (!buffer_is_right(__func__, values, count, expected)) return WISP_BAD_ARGUMENT;
  return bank->bank.set_inputs(id_of(instance), {values, count}) ? WISP_OK : not_alive(__func__);
}

wisp_status wisp_bank_set_noise(wisp_bank* bank, float scale) {
  if (!bank) return null_argument(__func__);
  bank->bank.set_noise(scale);
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

wisp_status wisp_bank_outputs(const wisp_bank* bank, float* values, size_t count) {
  if (!bank) return null_argument(__func__);
  if (!buffer_is_right(__func__, values, count, rows(bank, bank->bank.output_count()))) return WISP_BAD_ARGUMENT;
  bank->bank.outputs({values, count});
  return WISP_OK;
}

wisp_status wisp_bank_instance_outputs(const wisp_bank* bank, wisp_instance instance, float* values, size_t count) {
  if (!bank) return null_argument(__func__);
  const auto expected = static_cast<size_t>(bank->bank.output_count());
  if (!buffer_is_right(__func__, values, count, expected)) return WISP_BAD_ARGUMENT;
  return bank->bank.outputs(id_of(instance), {values, count}) ? WISP_OK : not_alive(__func__);
}

static bool has_outline(const char* function, const wisp_bank* bank) {
  if (bank->bank.polyline_points() > 0) return true;
  std::snprintf(last_error, sizeof last_error, "%s: the model's outputs are not an outline", function);
  return false;
}

wisp_status wisp_bank_polylines(const wisp_bank* bank, float* values, size_t count) {
  if (!bank) return null_argument(__func__);
  if (!has_outline(__func__, bank)) return WISP_BAD_ARGUMENT;
  const size_t expected = rows(bank, 2 * bank->bank.polyline_points());
  if (!buffer_is_right(__func__, values, count, expected)) return WISP_BAD_ARGUMENT;
  bank->bank.polylines({values, count});
  return WISP_OK;
}

wisp_status wisp_bank_polyline(const wisp_bank* bank, wisp_instance instance, float* values, size_t count) {
  if (!bank) return null_argument(__func__);
  if (!has_outline(__func__, bank)) return WISP_BAD_ARGUMENT;
  const auto expected = static_cast<size_t>(2 * bank->bank.polyline_points());
  if (!buffer_is_right(__func__, values, count, expected)) return WISP_BAD_ARGUMENT;
  return bank->bank.polyline(id_of(instance), {values, count}) ? WISP_OK : not_alive(__func__);
}

wisp_status wisp_bank_get_flame_state(const wisp_bank* bank, wisp_instance instance, wisp_flame_state* state) {
  if (!bank || !state) return null_argument(__func__);
  if (!size_is_right(__func__, state)) return WISP_BAD_ARGUMENT;
  const auto found = bank->bank.lit_state(id_of(instance));
  if (!found) return not_alive(__func__);
  wisp_flame_state filled{};
  filled.lit = found->lit ? 1 : 0;
  filled.flame_size = found->size;
  filled.since_lit = found->since_lit.count();
  filled.since_out = found->since_out.count();
  hand_out(filled, state);
  return WISP_OK;
}

wisp_status wisp_bank_flame_sizes(const wisp_bank* bank, float* values, size_t count) {
  if (!bank) return null_argument(__func__);
  if (!buffer_is_right(__func__, values, count, rows(bank, 1))) return WISP_BAD_ARGUMENT;
  for (int slot = 0; slot < bank->bank.slots(); ++slot) {
    const auto found = bank->bank.lit_state(bank->bank.at(slot));
    values[slot] = found ? found->size : 0.0f;
  }
  return WISP_OK;
}

wisp_status wisp_bank_relight(wisp_bank* bank, wisp_instance instance) {
  if (!bank) return null_argument(__func__);
  return bank->bank.relight(id_of(instance)) ? WISP_OK : not_alive(__func__);
}

wisp_status wisp_bank_extinguish(wisp_bank* bank, wisp_instance instance) {
  if (!bank) return null_argument(__func__);
  return bank->bank.extinguish(id_of(instance)) ? WISP_OK : not_alive(__func__);
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

}  // extern "C"
