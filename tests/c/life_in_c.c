/* The C ABI used from C99. */
#include "c/life_in_c.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "c/expect_in_c.h"
#include "wisp/wisp.h"

const char* whole_life(const void* bytes, size_t size, float outputs[16]) {
  wisp_model* model = NULL;
  wisp_bank* bank = NULL;
  wisp_bank* twin = NULL;
  wisp_instance flame = WISP_NO_INSTANCE, other = WISP_NO_INSTANCE;
  wisp_bank_options options = wisp_bank_default_options();
  wisp_model_facts facts;
  wisp_bank_facts life;
  wisp_channel wind_channel;
  float wind = 0.5f, points[2 * 12], all[2 * 16], all_points[2 * 2 * 12], again[16];
  size_t saved_size = 0;
  void* saved;
  int32_t steps = -1, step;

  EXPECT(wisp_version() == 1000);
  EXPECT(wisp_model_load(bytes, size, &model) == WISP_OK);
  EXPECT(strcmp(wisp_model_name(model), "made-up flame") == 0);
  memset(&facts, 0, sizeof facts);
  facts.size = sizeof facts;
  EXPECT(wisp_model_get_facts(model, &facts) == WISP_OK);
  EXPECT(facts.inputs == 1 && facts.outputs == 16 && facts.control_points == 8);
  EXPECT(facts.rate_hz == 30 && facts.step_nanoseconds == 33333333 && facts.metres_per_unit == 0.03);
  EXPECT(facts.multiply_adds_per_frame == 192 && facts.operations_per_frame > 192);
  wind_channel.size = sizeof wind_channel;
  EXPECT(wisp_model_get_input(model, 0, &wind_channel) == WISP_OK);
  EXPECT(strcmp(wind_channel.name, "wind") == 0 && wind_channel.highest == 1);
  EXPECT(wisp_model_get_output(model, 15, &wind_channel) == WISP_OK);
  EXPECT(strcmp(wind_channel.name, "p7.y") == 0);

  options.capacity = 2;
  options.polyline_points = 12;
  options.seed = 3;
  EXPECT(wisp_bank_create(model, &options, &bank) == WISP_OK);
  EXPECT(wisp_bank_create(model, &options, &twin) == WISP_OK);
  wisp_model_free(model); /* banks live on */

  EXPECT(wisp_bank_spawn(bank, &flame) == WISP_OK);
  EXPECT(wisp_bank_spawn_stream(bank, 0, &other) == WISP_OK);
  EXPECT(wisp_bank_alive(bank, flame) && wisp_bank_alive(bank, other) && flame != other);
  EXPECT(wisp_bank_at(bank, 1) == other);
  EXPECT(wisp_bank_set_common_inputs(bank, &wind, 1) == WISP_OK);
  for (step = 0; step < 50; ++step) EXPECT(wisp_bank_step(bank) == WISP_OK);
  EXPECT(wisp_bank_instance_outputs(bank, flame, outputs, 16) == WISP_OK);
  EXPECT(wisp_bank_outputs(bank, all, 32) == WISP_OK);
  EXPECT(memcmp(all, outputs, sizeof(float) * 16) == 0);
  EXPECT(memcmp(all + 16, outputs, sizeof(float) * 16) == 0); /* the same stream and wind: the same life */
  EXPECT(wisp_bank_polyline(bank, flame, points, 24) == WISP_OK);
  EXPECT(wisp_bank_polylines(bank, all_points, 48) == WISP_OK);
  EXPECT(memcmp(all_points, points, sizeof points) == 0);
  EXPECT(points[0] == outputs[0] && points[1] == outputs[1]); /* clamped: begins in its first control point */

  EXPECT(wisp_bank_save_bytes(bank, &saved_size) == WISP_OK);
  saved = malloc(saved_size);
  EXPECT(wisp_bank_save(bank, saved, saved_size) == WISP_OK);
  EXPECT(wisp_bank_restore(twin, saved, saved_size) == WISP_OK);
  free(saved);
  EXPECT(wisp_bank_instance_outputs(twin, flame, again, 16) == WISP_OK);
  EXPECT(memcmp(again, outputs, sizeof again) == 0);

  EXPECT(wisp_bank_advance(bank, 100000000, &steps) == WISP_OK);
  EXPECT(steps == 3);
  EXPECT(wisp_bank_advance(bank, 0, NULL) == WISP_OK);
  EXPECT(wisp_bank_set_noise(bank, 0) == WISP_OK);
  EXPECT(wisp_bank_reset_instance(bank, flame) == WISP_OK);
  EXPECT(wisp_bank_reset(bank) == WISP_OK);
  EXPECT(wisp_bank_end(bank, other) == WISP_OK);
  EXPECT(!wisp_bank_alive(bank, other));
  life.size = sizeof life;
  EXPECT(wisp_bank_get_facts(bank, &life) == WISP_OK);
  EXPECT(life.alive == 1 && life.slots == 1 && life.capacity == 2 && life.polyline_points == 12);
  EXPECT(life.steps == 106 && life.clamped == 0);
  wisp_bank_free(bank);
  wisp_bank_free(twin);
  return NULL;
}

const char* life_in_given_memory(const void* bytes, size_t size) {
  wisp_model* model = NULL;
  wisp_bank *bank = NULL, *twin = NULL;
  wisp_bank_options options = wisp_bank_default_options();
  wisp_instance flame;
  size_t needed = 0;
  float a[16], b[16];
  EXPECT(wisp_model_load(bytes, size, &model) == WISP_OK);
  EXPECT(wisp_bank_bytes(model, NULL, &needed) == WISP_OK);
  options.memory = malloc(needed);
  options.memory_size = needed;
  EXPECT(wisp_bank_create(model, &options, &bank) == WISP_OK);
  EXPECT(wisp_bank_create(model, NULL, &twin) == WISP_OK);
  wisp_model_free(model);
  EXPECT(wisp_bank_spawn(bank, &flame) == WISP_OK);
  EXPECT(wisp_bank_spawn(twin, &flame) == WISP_OK);
  EXPECT(wisp_bank_step(bank) == WISP_OK);
  EXPECT(wisp_bank_step(twin) == WISP_OK);
  EXPECT(wisp_bank_outputs(bank, a, 16) == WISP_OK);
  EXPECT(wisp_bank_outputs(twin, b, 16) == WISP_OK);
  EXPECT(memcmp(a, b, sizeof a) == 0);
  wisp_bank_free(bank);
  wisp_bank_free(twin);
  free(options.memory);
  return NULL;
}

static const char* misuse_of_models(const void* bytes, size_t size) {
  wisp_model* model = NULL;
  wisp_channel channel;
  unsigned char* copy = malloc(size);
  memcpy(copy, bytes, size);
  copy[size / 2] ^= 1;
  EXPECT_FAILURE(wisp_model_load(copy, size, &model), WISP_BAD_DATA, "damaged");
  free(copy);
  EXPECT_FAILURE(wisp_model_load(bytes, 10, &model), WISP_BAD_DATA, "cut short");
  EXPECT_FAILURE(wisp_model_load("hello, I am no model", 20, &model), WISP_BAD_DATA, "not a .wisp model");
  EXPECT_FAILURE(wisp_model_load(NULL, 10, &model), WISP_BAD_ARGUMENT, "null pointer");
  EXPECT_FAILURE(wisp_model_load(bytes, size, NULL), WISP_BAD_ARGUMENT, "null pointer");
  EXPECT(model == NULL);
  EXPECT(wisp_model_load(bytes, size, &model) == WISP_OK);
  channel.size = sizeof channel;
  EXPECT_FAILURE(wisp_model_get_input(model, 1, &channel), WISP_BAD_ARGUMENT, "index 1, expected less than 1");
  EXPECT_FAILURE(wisp_model_get_output(model, 16, &channel), WISP_BAD_ARGUMENT, "index 16");
  EXPECT_FAILURE(wisp_model_get_output(NULL, 0, &channel), WISP_BAD_ARGUMENT, "wisp_model_get_output");
  EXPECT(strcmp(wisp_model_name(NULL), "") == 0);
  wisp_model_free(model);
  wisp_model_free(NULL);
  return NULL;
}

static const char* misuse_of_options(const wisp_model* model) {
  wisp_bank* bank = NULL;
  wisp_bank_options options = wisp_bank_default_options();
  unsigned char little[64];
  options.capacity = 0xffffffffu;
  EXPECT_FAILURE(wisp_bank_create(model, &options, &bank), WISP_BAD_ARGUMENT, "capacity");
  options = wisp_bank_default_options();
  options.polyline_points = 1;
  EXPECT_FAILURE(wisp_bank_create(model, &options, &bank), WISP_BAD_ARGUMENT, "polyline");
  options = wisp_bank_default_options();
  options.memory = little;
  options.memory_size = sizeof little;
  EXPECT_FAILURE(wisp_bank_create(model, &options, &bank), WISP_BAD_ARGUMENT, "given 64 bytes");
  options.memory_size = 0;
  EXPECT_FAILURE(wisp_bank_create(model, &options, &bank), WISP_BAD_ARGUMENT, "given 0 bytes");
  EXPECT_FAILURE(wisp_bank_create(NULL, NULL, &bank), WISP_BAD_ARGUMENT, "wisp_bank_create");
  EXPECT_FAILURE(wisp_bank_create(model, NULL, NULL), WISP_BAD_ARGUMENT, "wisp_bank_create");
  EXPECT(bank == NULL);
  return NULL;
}

static const char* misuse_of_a_bank(wisp_bank* bank) {
  wisp_instance flame = WISP_NO_INSTANCE, none = WISP_NO_INSTANCE;
  float values[64] = {0};
  float not_a_number = nanf("");
  unsigned char rubbish[100] = {0};
  size_t count = 0;
  EXPECT(wisp_bank_spawn(bank, &flame) == WISP_OK);
  EXPECT_FAILURE(wisp_bank_spawn(bank, &none), WISP_NO_INSTANCE_LEFT, "full");
  EXPECT(none == WISP_NO_INSTANCE);
  EXPECT_FAILURE(wisp_bank_end(bank, none), WISP_NOT_ALIVE, "not alive");
  EXPECT_FAILURE(wisp_bank_end(bank, ~(wisp_instance)0), WISP_NOT_ALIVE, "not alive");
  EXPECT_FAILURE(wisp_bank_instance_outputs(bank, none, values, 16), WISP_NOT_ALIVE, "not alive");
  EXPECT_FAILURE(wisp_bank_polyline(bank, none, values, 64), WISP_NOT_ALIVE, "not alive");
  EXPECT_FAILURE(wisp_bank_set_instance_inputs(bank, none, values, 1), WISP_NOT_ALIVE, "not alive");
  EXPECT_FAILURE(wisp_bank_reset_instance(bank, none), WISP_NOT_ALIVE, "not alive");
  EXPECT_FAILURE(wisp_bank_set_inputs(bank, values, 0), WISP_BAD_ARGUMENT, "room for 0, expected at least 1");
  EXPECT_FAILURE(wisp_bank_set_inputs(bank, NULL, 1), WISP_BAD_ARGUMENT, "null pointer");
  EXPECT_FAILURE(wisp_bank_set_common_inputs(bank, values, 0), WISP_BAD_ARGUMENT, "room for 0, expected 1");
  EXPECT_FAILURE(wisp_bank_set_instance_inputs(bank, flame, values, 3), WISP_BAD_ARGUMENT, "expected 1");
  EXPECT_FAILURE(wisp_bank_outputs(bank, values, 15), WISP_BAD_ARGUMENT, "room for 15, expected at least 16");
  EXPECT_FAILURE(wisp_bank_instance_outputs(bank, flame, values, 17), WISP_BAD_ARGUMENT, "expected 16");
  EXPECT_FAILURE(wisp_bank_polylines(bank, values, 63), WISP_BAD_ARGUMENT, "expected at least 64");
  EXPECT_FAILURE(wisp_bank_polyline(bank, flame, values, 65), WISP_BAD_ARGUMENT, "expected 64");
  EXPECT_FAILURE(wisp_bank_save(bank, rubbish, 100), WISP_BAD_ARGUMENT, "room for 100");
  EXPECT_FAILURE(wisp_bank_restore(bank, rubbish, 100), WISP_BAD_DATA, "not a saved bank");
  EXPECT_FAILURE(wisp_bank_restore(bank, NULL, 0), WISP_BAD_ARGUMENT, "null pointer");
  EXPECT_FAILURE(wisp_bank_save_bytes(NULL, &count), WISP_BAD_ARGUMENT, "null pointer");
  EXPECT_FAILURE(wisp_bank_step(NULL), WISP_BAD_ARGUMENT, "wisp_bank_step");
  EXPECT_FAILURE(wisp_bank_advance(NULL, 1, NULL), WISP_BAD_ARGUMENT, "wisp_bank_advance");
  EXPECT_FAILURE(wisp_bank_spawn(NULL, &none), WISP_BAD_ARGUMENT, "null pointer");
  EXPECT(wisp_bank_alive(NULL, flame) == 0 && wisp_bank_at(NULL, 0) == WISP_NO_INSTANCE);
  EXPECT(wisp_bank_at(bank, 1) == WISP_NO_INSTANCE && wisp_bank_at(bank, 0xffffffffu) == WISP_NO_INSTANCE);
  EXPECT(wisp_bank_set_common_inputs(bank, &not_a_number, 1) == WISP_OK);
  EXPECT(wisp_bank_advance(bank, INT64_MIN, NULL) == WISP_OK);
  EXPECT(wisp_bank_advance(bank, INT64_MAX, NULL) == WISP_OK);
  EXPECT(wisp_bank_outputs(bank, values, 16) == WISP_OK);
  EXPECT(isfinite(values[0]) && isfinite(values[15]));
  EXPECT(wisp_bank_alive(bank, flame));
  return NULL;
}

const char* misuse(const void* bytes, size_t size) {
  wisp_model* model = NULL;
  wisp_bank* bank = NULL;
  const char* wrong = misuse_of_models(bytes, size);
  if (wrong) return wrong;
  EXPECT(wisp_model_load(bytes, size, &model) == WISP_OK);
  wrong = misuse_of_options(model);
  if (wrong) return wrong;
  EXPECT(wisp_bank_create(model, NULL, &bank) == WISP_OK);
  wisp_model_free(model);
  wrong = misuse_of_a_bank(bank);
  wisp_bank_free(bank);
  wisp_bank_free(NULL);
  return wrong;
}

const char* structs_of_other_sizes(const void* bytes, size_t size) {
  struct {
    wisp_model_facts facts;
    uint64_t later;
  } newer;
  wisp_model* model = NULL;
  wisp_model_facts older;
  wisp_bank_options options = wisp_bank_default_options();
  wisp_bank* bank = NULL;
  wisp_bank_facts life;
  EXPECT(wisp_model_load(bytes, size, &model) == WISP_OK);
  newer.facts.size = sizeof newer;
  newer.later = 42;
  EXPECT(wisp_model_get_facts(model, &newer.facts) == WISP_OK);
  EXPECT(newer.facts.outputs == 16 && newer.later == 42 && newer.facts.size == sizeof newer);
  memset(&older, 0x55, sizeof older);
  older.size = 12;
  EXPECT(wisp_model_get_facts(model, &older) == WISP_OK);
  EXPECT(older.inputs == 1 && older.outputs == 16 && older.control_points == 0x55555555u);
  older.size = 0;
  EXPECT_FAILURE(wisp_model_get_facts(model, &older), WISP_BAD_ARGUMENT, "set it to sizeof");
  options.size = 8; /* a caller that knows of no field but the capacity */
  options.capacity = 3;
  options.polyline_points = 1;
  EXPECT(wisp_bank_create(model, &options, &bank) == WISP_OK);
  life.size = sizeof life;
  EXPECT(wisp_bank_get_facts(bank, &life) == WISP_OK);
  EXPECT(life.capacity == 3 && life.polyline_points == 32);
  wisp_bank_free(bank);
  wisp_model_free(model);
  return NULL;
}

const char* death_in_c(const void* bytes, size_t size) {
  wisp_model* model = NULL;
  wisp_bank* bank = NULL;
  wisp_instance flame = WISP_NO_INSTANCE;
  wisp_model_facts facts;
  wisp_flame_state state;
  float wind = 4, still = 0, outputs[16], flame_size = -1;
  int step;

  EXPECT(wisp_model_load(bytes, size, &model) == WISP_OK);
  facts.size = sizeof facts;
  EXPECT(wisp_model_get_facts(model, &facts) == WISP_OK);
  EXPECT(facts.blow_out_level == 2 && facts.blow_out_seconds == 0.2);
  EXPECT(wisp_bank_create(model, NULL, &bank) == WISP_OK);
  EXPECT(wisp_bank_spawn(bank, &flame) == WISP_OK);
  memset(&state, 0, sizeof state);
  state.size = sizeof state;
  EXPECT(wisp_bank_get_flame_state(bank, flame, &state) == WISP_OK);
  EXPECT(state.lit == 1 && state.flame_size == 1 && state.since_lit == WISP_NEVER && state.since_out == WISP_NEVER);

  EXPECT(wisp_bank_set_common_inputs(bank, &wind, 1) == WISP_OK);
  for (step = 0; step < 30; ++step) EXPECT(wisp_bank_step(bank) == WISP_OK);
  EXPECT(wisp_bank_set_common_inputs(bank, &still, 1) == WISP_OK);
  for (step = 0; step < 30; ++step) EXPECT(wisp_bank_step(bank) == WISP_OK);
  EXPECT(wisp_bank_get_flame_state(bank, flame, &state) == WISP_OK);
  EXPECT(state.lit == 0 && state.flame_size == 0 && state.since_out > 1000000000);
  EXPECT(wisp_bank_instance_outputs(bank, flame, outputs, 16) == WISP_OK && outputs[9] == 0);
  EXPECT(wisp_bank_flame_sizes(bank, &flame_size, 1) == WISP_OK && flame_size == 0);

  EXPECT(wisp_bank_relight(bank, flame) == WISP_OK);
  for (step = 0; step < 30; ++step) EXPECT(wisp_bank_step(bank) == WISP_OK);
  EXPECT(wisp_bank_get_flame_state(bank, flame, &state) == WISP_OK);
  EXPECT(state.lit == 1 && state.flame_size == 1 && state.since_lit < 1100000000);
  EXPECT(wisp_bank_instance_outputs(bank, flame, outputs, 16) == WISP_OK && outputs[9] > 0.5f);
  EXPECT(wisp_bank_extinguish(bank, flame) == WISP_OK);
  state.size = 2 * sizeof(uint32_t); /* a caller that knows no more than whether it burns */
  state.since_out = 7;
  EXPECT(wisp_bank_get_flame_state(bank, flame, &state) == WISP_OK && state.lit == 0 && state.since_out == 7);

  state.size = sizeof state;
  EXPECT(wisp_bank_get_flame_state(NULL, flame, &state) == WISP_BAD_ARGUMENT);
  EXPECT(wisp_bank_get_flame_state(bank, flame, NULL) == WISP_BAD_ARGUMENT);
  EXPECT(wisp_bank_get_flame_state(bank, WISP_NO_INSTANCE, &state) == WISP_NOT_ALIVE);
  EXPECT(wisp_bank_flame_sizes(bank, &flame_size, 0) == WISP_BAD_ARGUMENT);
  EXPECT(wisp_bank_relight(bank, WISP_NO_INSTANCE) == WISP_NOT_ALIVE);
  EXPECT(wisp_bank_extinguish(bank, WISP_NO_INSTANCE) == WISP_NOT_ALIVE);
  EXPECT(wisp_bank_relight(NULL, flame) == WISP_BAD_ARGUMENT);
  wisp_bank_free(bank);
  wisp_model_free(model);
  return NULL;
}
