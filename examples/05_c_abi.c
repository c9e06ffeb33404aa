/* Blows on a flame from C for two seconds: one line for each frame of 1/60 s with the time, whether the flame burns,
 * and where the middle of its outline is.
 *
 *   05_c_abi MODEL.wisp */

#include <stdio.h>

#include "wisp/wisp.h"

static int complain(void) { return fprintf(stderr, "05_c_abi: %s\n", wisp_last_error()), 1; }

int main(int argc, char** argv) {
  static char bytes[1 << 20];
  float outline[2 * 32]; /* x, y, x, y, ...: 32 points unless the bank's options say otherwise */
  wisp_model* model;
  wisp_bank* bank;
  wisp_instance flame;
  wisp_flame_state state = {.size = sizeof state};
  wisp_bank_facts facts = {.size = sizeof facts};
  FILE* file = fopen(argc > 1 ? argv[1] : "flame.wisp", "rb");
  if (!file) return perror("05_c_abi: the model cannot be read"), 1;
  const size_t size = fread(bytes, 1, sizeof bytes, file);
  fclose(file);
  if (wisp_model_load(bytes, size, &model) != WISP_OK) return complain();
  if (wisp_bank_create(model, NULL, &bank) != WISP_OK) return complain(); /* room for one flame */
  wisp_model_free(model);                                                 /* the bank lives on without it */
  if (wisp_bank_spawn(bank, &flame) != WISP_OK) return complain();
  if (wisp_bank_get_facts(bank, &facts) != WISP_OK) return complain();
  for (int frame = 0; frame < 120; ++frame) {
    const float wind = frame >= 30 && frame < 90 ? 2.0f : 0.0f; /* 1 is a strong gust */
    /* A flame that was learned from a clip without wind has no input. */
    if (facts.inputs > 0 && wisp_bank_set_common_inputs(bank, &wind, 1) != WISP_OK) return complain();
    if (wisp_bank_advance(bank, 16666667, NULL) != WISP_OK) return complain();
    if (wisp_bank_polyline(bank, flame, outline, 2 * 32) != WISP_OK) return complain();
    if (wisp_bank_get_flame_state(bank, flame, &state) != WISP_OK) return complain();
    printf("%.3f  %s  %.4f %.4f\n", frame / 60.0, state.lit ? "burns" : "out  ", outline[32], outline[33]);
  }
  wisp_bank_free(bank);
  return 0;
}
