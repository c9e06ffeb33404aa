/* The C ABI's bits. */
#include "c/frames_in_c.h"

#include <stdlib.h>
#include <string.h>

#include "wisp/wisp.h"

#define NEED(call) \
  if ((call) != WISP_OK) return wisp_last_error()

/* Two of FNV's 32-bit hashes, word by word, the second of the word with its halves swapped. */
static void fold(uint32_t hash[2], const float* values, size_t count) {
  size_t k;
  for (k = 0; k < count; ++k) {
    uint32_t word;
    memcpy(&word, &values[k], sizeof word);
    hash[0] = (hash[0] ^ word) * 16777619u;
    hash[1] = (hash[1] ^ (word >> 16 | word << 16)) * 16777619u;
  }
}

static void start(uint32_t hash[2]) { hash[0] = hash[1] = 2166136261u; }

/* -1 to 1, by a linear congruence. */
static float chance(uint32_t* state) {
  *state = *state * 1664525u + 1013904223u;
  return (float)((int32_t)*state >> 8) / 8388608.0f;
}

/* Thrown from where it began, or nothing where there is nothing to throw. */
static const char* throw_again(wisp_bank* bank, wisp_instance instance) {
  wisp_body body;
  memset(&body, 0, sizeof body);
  body.size = sizeof body;
  body.orientation[0] = 0.75f;
  body.orientation[1] = 0.5f;
  body.velocity[0] = 0.5f;
  body.velocity[2] = -0.25f;
  NEED(wisp_bank_place(bank, instance, &body));
  return NULL;
}

/* A restored bank goes on as it was. */
static const char* save_and_restore(wisp_bank* bank) {
  size_t size = 0;
  void* saved;
  wisp_status status;
  NEED(wisp_bank_save_bytes(bank, &size));
  saved = malloc(size);
  status = wisp_bank_save(bank, saved, size);
  if (status == WISP_OK) status = wisp_bank_restore(bank, saved, size);
  free(saved);
  return status == WISP_OK ? NULL : wisp_last_error();
}

const char* hash_of_life(const void* bytes, size_t size, uint32_t frames, uint32_t hash[2]) {
  enum { kInstances = 2, kMaxInputs = 8, kMaxOutputs = 64 };
  wisp_model* model = NULL;
  wisp_bank* bank = NULL;
  wisp_bank_options options = wisp_bank_default_options();
  wisp_bank_facts facts;
  wisp_instance instance[kInstances];
  wisp_model_facts about;
  float wind[kMaxInputs], outputs[kInstances * kMaxOutputs];
  uint32_t frame, k, state = 1;
  const char* wrong = NULL;
  NEED(wisp_model_load(bytes, size, &model));
  options.capacity = kInstances;
  options.seed = 7;
  NEED(wisp_bank_create(model, &options, &bank));
  about.size = sizeof about;
  NEED(wisp_model_get_facts(model, &about));
  wisp_model_free(model);
  for (k = 0; k < kInstances; ++k) NEED(wisp_bank_spawn(bank, &instance[k]));
  facts.size = sizeof facts;
  NEED(wisp_bank_get_facts(bank, &facts));
  if (facts.inputs > kMaxInputs || facts.outputs > kMaxOutputs) return "the model is too large for this test";
  start(hash);
  for (frame = 0; frame < frames && !wrong; ++frame) {
    if (frame % 7 == 0) {
      for (k = 0; k < facts.inputs; ++k) wind[k] = 2 * chance(&state);
      NEED(wisp_bank_set_common_inputs(bank, wind, facts.inputs));
    }
    NEED(wisp_bank_advance(bank, 16666667, NULL));
    NEED(wisp_bank_outputs(bank, outputs, kInstances * facts.outputs));
    fold(hash, outputs, kInstances * facts.outputs);
    if (frame % 500 == 499 && about.blow_out_level > 0)
      NEED(wisp_bank_relight(bank, instance[frame / 500 % kInstances]));
    if (frame % 5000 == 4999) wrong = save_and_restore(bank);
    if (!wrong && frame % 700 == 699 && about.dynamics == WISP_DYNAMICS_CHAIN) wrong = throw_again(bank, instance[0]);
  }
  wisp_bank_free(bank);
  return wrong;
}

const char* hash_of_wind(uint32_t seconds, uint32_t hash[2]) {
  enum { kRate = 48000, kBlock = 128 };
  wisp_wind* wind = NULL;
  wisp_wind_options options = wisp_wind_default_options();
  wisp_wind_frame frames[2];
  float samples[kBlock];
  uint32_t position = 0, k, state = 1;
  double rumble = 0; /* of what is added, all is exact but the sums: fusing them changes nothing */
  size_t made, frame;
  options.rate_hz = kRate;
  NEED(wisp_wind_create(&options, &wind));
  start(hash);
  while (position < seconds * kRate) {
    for (k = 0; k < kBlock; ++k, ++position) {
      const int blows = position > 2 * kRate && position / (kRate / 2) % 3 == 0;
      const double one = (double)chance(&state);
      rumble += (one - rumble) / 16;
      samples[k] = (float)((blows ? 2 * rumble : 0) + one / 1024);
    }
    NEED(wisp_wind_feed(wind, samples, kBlock, frames, 2, NULL, &made));
    for (frame = 0; frame < made; ++frame) fold(hash, &frames[frame].rms, 8);
  }
  wisp_wind_free(wind);
  return NULL;
}
