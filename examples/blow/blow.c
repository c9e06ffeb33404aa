/* Blows on a flame with a recorded sound, through the C ABI: one line for each frame of 1/60 s with the time, the wind
 * that the sound makes, whether the flame burns, and where its tip is.
 *
 *   ffmpeg -i breath.wav -f s16le -ac 1 -ar 48000 breath.raw
 *   blow MODEL.wisp breath.raw */

#include <stdio.h>
#include <stdlib.h>

#include "wisp/wisp.h"

enum { kRate = 48000, kFramesPerSecond = 60, kBlock = 512, kMostFrames = 8 };

static int complain(const char* what) {
  fprintf(stderr, "blow: %s: %s\n", what, wisp_last_error());
  return 1;
}

/* A whole file; NULL when it cannot be read. */
static void* read_file(const char* path, size_t* size) {
  FILE* file = fopen(path, "rb");
  void* bytes = NULL;
  if (!file) return NULL;
  fseek(file, 0, SEEK_END);
  *size = (size_t)ftell(file);
  rewind(file);
  bytes = malloc(*size + 1);
  if (bytes) *size = fread(bytes, 1, *size, file);
  fclose(file);
  return bytes;
}

/* Wind in, a sixtieth of a second on, the outline out. */
static int show_frame(wisp_bank* bank, wisp_instance flame, const wisp_wind_frame* heard) {
  float outline[2 * 32], *tip = outline;
  wisp_flame_state state;
  int point;
  if (wisp_bank_set_common_inputs(bank, &heard->wind, 1) != WISP_OK) return complain("wind");
  wisp_bank_advance(bank, 1000000000 / kFramesPerSecond, NULL);
  if (wisp_bank_polyline(bank, flame, outline, 2 * 32) != WISP_OK) return complain("outline");
  for (point = 1; point < 32; ++point) {
    if (outline[2 * point + 1] > tip[1]) tip = &outline[2 * point];
  }
  state.size = sizeof state;
  wisp_bank_get_flame_state(bank, flame, &state);
  printf("%7.3f  wind %5.2f  %s  tip %6.3f %6.3f\n", (double)heard->index / kFramesPerSecond, heard->wind,
         state.lit ? "burns" : "out  ", tip[0], tip[1]);
  return 0;
}

static int blow(wisp_bank* bank, FILE* sound) {
  wisp_wind_options options = wisp_wind_default_options();
  wisp_wind* wind = NULL;
  wisp_instance flame;
  int16_t samples[kBlock];
  size_t count;
  int failed = 0;
  if (wisp_bank_spawn(bank, &flame) != WISP_OK) return complain("a flame");
  options.rate_hz = kRate;
  options.frame_rate_hz = kFramesPerSecond;
  if (wisp_wind_create(&options, &wind) != WISP_OK) return complain("the wind");
  while (!failed && (count = fread(samples, sizeof *samples, kBlock, sound)) > 0) {
    wisp_wind_frame frames[kMostFrames]; /* 512 samples end one frame at most */
    size_t made = 0, frame;
    failed = wisp_wind_feed_int16(wind, samples, count, frames, kMostFrames, NULL, &made) != WISP_OK;
    for (frame = 0; frame < made && !failed; ++frame) failed = show_frame(bank, flame, &frames[frame]);
  }
  wisp_wind_free(wind);
  return failed;
}

int main(int argc, char** argv) {
  wisp_model* model = NULL;
  wisp_bank* bank = NULL;
  size_t size = 0;
  void* bytes;
  FILE* sound;
  wisp_status status;
  int failed;
  if (argc != 3) {
    fprintf(stderr, "usage: blow MODEL.wisp SOUND.raw\n");
    return 2;
  }
  bytes = read_file(argv[1], &size);
  sound = fopen(argv[2], "rb");
  if (!bytes || !sound) {
    fprintf(stderr, "blow: %s cannot be read\n", bytes ? argv[2] : argv[1]);
    return 1;
  }
  status = wisp_model_load(bytes, size, &model);
  free(bytes);
  if (status != WISP_OK) return complain(argv[1]);
  status = wisp_bank_create(model, NULL, &bank); /* room for one flame; the bank lives on without the model */
  wisp_model_free(model);
  if (status != WISP_OK) return complain("the bank");
  failed = blow(bank, sound);
  wisp_bank_free(bank);
  fclose(sound);
  return failed;
}
