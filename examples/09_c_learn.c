/* Learns from arrays, and plays what was learned, over the C ABI: a made-up pendulum that wind pushes.
 *
 *     09_c_learn */

#include <math.h>
#include <stdint.h>
#include <stdio.h>

#include "wisp/wisp.h"

enum { kRows = 2000 };

/* A recording: a slow gust, and a swing of about a second that it drives. */
static void record(double wind[kRows], double lean[kRows]) {
  double chance = 0;
  uint32_t word = 1;
  for (int t = 0; t < kRows; ++t) {
    word = word * 1664525u + 1013904223u;
    chance = (double)(word >> 8) / (1 << 24) - 0.5;
    wind[t] = sin(0.02 * t) > 0 ? 1.0 : 0.0;
    lean[t] = (t > 1 ? 1.92 * lean[t - 1] - 0.96 * lean[t - 2] : 0) + (t > 0 ? 0.02 * wind[t - 1] : 0) + 0.004 * chance;
  }
}

static int failed(const char* what) {
  fprintf(stderr, "%s: %s\n", what, wisp_last_error());
  return 1;
}

int main(void) {
  static double wind[kRows], lean[kRows];
  wisp_recording* recording = NULL;
  wisp_recipe recipe = wisp_recipe_default(WISP_RECIPE_ARX);
  wisp_fit* fit = NULL;
  wisp_model* model = NULL;
  wisp_bank* bank = NULL;
  wisp_instance pendulum = WISP_NO_INSTANCE;
  const void* bytes = NULL;
  size_t size = 0;
  float blow = 1, swing = 0;

  record(wind, lean);
  recipe.na = 2;
  recipe.nb = 1;
  if (wisp_recording_create(30, &recording) != WISP_OK) return failed("the recording");
  if (wisp_recording_add(recording, WISP_ROLE_INPUT, "wind", NULL, wind, kRows) != WISP_OK) return failed("wind");
  if (wisp_recording_add(recording, WISP_ROLE_OUTPUT, "lean", "m", lean, kRows) != WISP_OK) return failed("lean");
  if (wisp_learn((const wisp_recording* const*)&recording, 1, &recipe, NULL, NULL, &fit) != WISP_OK) {
    return failed("learning");
  }
  wisp_recording_free(recording);
  if (wisp_fit_get_model(fit, &bytes, &size) != WISP_OK) return failed("the model");
  printf("%s: %s, %u bytes\n", wisp_fit_usable(fit) ? "usable" : "not usable", wisp_fit_reason(fit), (unsigned)size);
  if (wisp_model_load(bytes, size, &model) != WISP_OK) return failed("loading");
  wisp_fit_free(fit);
  if (wisp_bank_create(model, NULL, &bank) != WISP_OK || wisp_bank_spawn(bank, &pendulum) != WISP_OK)
    return failed("a bank");
  wisp_bank_set_noise(bank, 0);
  wisp_bank_set_common_inputs(bank, &blow, 1);
  for (int t = 0; t < 300; ++t) wisp_bank_step(bank);
  wisp_bank_outputs(bank, &swing, 1);
  printf("in a steady wind it leans %.2f m\n", swing);
  wisp_bank_free(bank);
  wisp_model_free(model);
  return 0;
}
