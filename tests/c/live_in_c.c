/* The C ABI used live from C99. */
#include "c/live_in_c.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "c/expect_in_c.h"
#include "wisp/wisp.h"

static const char* account_of_how_it_was_made(const wisp_model* model) {
  wisp_provenance made;
  wisp_note option;
  wisp_figure figure;
  const char* source = NULL;
  made.size = sizeof made;
  EXPECT(wisp_model_get_provenance(model, &made) == WISP_OK);
  EXPECT(made.sources == 1 && made.options == 1 && made.figures == 1 && made.usable == 1);
  EXPECT(strcmp(made.program, "wisp 0.1.0") == 0 && strcmp(made.reason, "made up") == 0);
  EXPECT(wisp_model_get_source(model, 0, &source) == WISP_OK && strcmp(source, "clip.mp4") == 0);
  option.size = sizeof option;
  EXPECT(wisp_model_get_option(model, 0, &option) == WISP_OK);
  EXPECT(strcmp(option.name, "order") == 0 && strcmp(option.value, "4") == 0);
  figure.size = sizeof figure;
  EXPECT(wisp_model_get_figure(model, 0, &figure) == WISP_OK);
  EXPECT(strcmp(figure.name, "fit") == 0 && figure.value == 61.5);
  EXPECT_FAILURE(wisp_model_get_source(model, 1, &source), WISP_BAD_ARGUMENT, "index 1, expected less than 1");
  EXPECT_FAILURE(wisp_model_get_option(model, 7, &option), WISP_BAD_ARGUMENT, "index 7");
  EXPECT_FAILURE(wisp_model_get_figure(model, 1, &figure), WISP_BAD_ARGUMENT, "index 1");
  EXPECT_FAILURE(wisp_model_get_figure(NULL, 0, &figure), WISP_BAD_ARGUMENT, "null pointer");
  EXPECT_FAILURE(wisp_model_get_source(model, 0, NULL), WISP_BAD_ARGUMENT, "null pointer");
  figure.size = 0;
  EXPECT_FAILURE(wisp_model_get_figure(model, 0, &figure), WISP_BAD_ARGUMENT, "set it to sizeof");
  made.size = 8; /* a caller that knows of no more than the count of sources */
  made.options = 42;
  EXPECT(wisp_model_get_provenance(model, &made) == WISP_OK && made.sources == 1 && made.options == 42);
  return NULL;
}

const char* account_of_a_flame(const void* bytes, size_t size) {
  wisp_model* model = NULL;
  wisp_model_facts facts;
  wisp_channel wind;
  wisp_arx_facts arx;
  wisp_chain_facts chain;
  int32_t na[16 * 16], nb[16 * 6], nk[16 * 6];
  double noise[16];
  const char* wrong;
  EXPECT(wisp_model_load(bytes, size, &model) == WISP_OK);
  facts.size = sizeof facts;
  EXPECT(wisp_model_get_facts(model, &facts) == WISP_OK);
  EXPECT(facts.dynamics == WISP_DYNAMICS_ARX && facts.view == WISP_VIEW_OUTLINE && facts.control_points == 8);
  EXPECT(facts.blow_out_level == 1.3 && facts.blow_out_haste == 2 && facts.blow_out_input == 0);
  EXPECT(facts.half_width == 0 && facts.half_length == 0);
  wind.size = sizeof wind;
  EXPECT(wisp_model_get_input(model, 0, &wind) == WISP_OK);
  EXPECT(wind.lowest == -1 && wind.highest == 1 && wind.even_odd == 1);
  arx.size = sizeof arx;
  EXPECT(wisp_model_get_arx(model, &arx) == WISP_OK);
  EXPECT(arx.outputs == 16 && arx.regressors == 6 && arx.resamples == 0 && arx.history == 4);
  EXPECT(wisp_model_arx_na(model, na, 256) == WISP_OK && na[0] == 4 && na[1] == 4 && na[2] == 0 && na[255] == 4);
  EXPECT(wisp_model_arx_nb(model, nb, 96) == WISP_OK && nb[0] == 0 && nb[3] == 4 && nb[6] == 4);
  EXPECT(wisp_model_arx_nk(model, nk, 96) == WISP_OK && nk[0] == 0);
  EXPECT(wisp_model_arx_noise(model, noise, 16) == WISP_OK && noise[0] == 0.006 && noise[1] == 0.008);
  EXPECT_FAILURE(wisp_model_arx_na(model, na, 255), WISP_BAD_ARGUMENT, "room for 255, expected 256");
  EXPECT_FAILURE(wisp_model_arx_nb(model, NULL, 96), WISP_BAD_ARGUMENT, "null pointer");
  EXPECT_FAILURE(wisp_model_arx_nk(NULL, nk, 96), WISP_BAD_ARGUMENT, "null pointer");
  chain.size = sizeof chain;
  EXPECT_FAILURE(wisp_model_get_chain(model, &chain), WISP_BAD_ARGUMENT, "not a chain");
  EXPECT_FAILURE(wisp_model_chain_initial(model, noise, 16), WISP_BAD_ARGUMENT, "not a chain");
  wrong = account_of_how_it_was_made(model);
  wisp_model_free(model);
  return wrong;
}

const char* account_of_a_leaf(const void* bytes, size_t size) {
  wisp_model* model = NULL;
  wisp_model_facts facts;
  wisp_arx_facts arx;
  wisp_chain_facts chain;
  double initial[2], transitions[4];
  uint32_t modes[3], steps[3];
  EXPECT(wisp_model_load(bytes, size, &model) == WISP_OK);
  facts.size = sizeof facts;
  EXPECT(wisp_model_get_facts(model, &facts) == WISP_OK);
  EXPECT(facts.dynamics == WISP_DYNAMICS_CHAIN && facts.view == WISP_VIEW_POSE && facts.inputs == 3);
  EXPECT(facts.half_width == 0.0365 && facts.half_length == 0.0245 && facts.blow_out_level == 0);
  chain.size = sizeof chain;
  EXPECT(wisp_model_get_chain(model, &chain) == WISP_OK);
  EXPECT(chain.modes == 2 && chain.segments == 3 && chain.history == 2);
  EXPECT(chain.gust_order == 1 && chain.heading_free == 1);
  EXPECT(wisp_model_chain_initial(model, initial, 2) == WISP_OK && initial[0] == 0.75 && initial[1] == 0.25);
  EXPECT(wisp_model_chain_transitions(model, transitions, 4) == WISP_OK && transitions[1] == 0.75);
  EXPECT(wisp_model_chain_segments(model, modes, steps, 3) == WISP_OK);
  EXPECT(modes[0] == 0 && modes[2] == 1 && steps[0] == 8 && steps[2] == 12);
  EXPECT(wisp_model_chain_segments(model, NULL, steps, 3) == WISP_OK);
  EXPECT_FAILURE(wisp_model_chain_segments(model, modes, NULL, 2), WISP_BAD_ARGUMENT, "room for 2, expected 3");
  EXPECT_FAILURE(wisp_model_chain_transitions(model, transitions, 2), WISP_BAD_ARGUMENT,
                 "wisp_model_chain_transitions was given room for 2, expected 4");
  EXPECT_FAILURE(wisp_model_chain_initial(model, NULL, 2), WISP_BAD_ARGUMENT, "null pointer");
  arx.size = sizeof arx;
  EXPECT_FAILURE(wisp_model_get_arx(model, &arx), WISP_BAD_ARGUMENT, "not ARX");
  wisp_model_free(model);
  return NULL;
}

static const char* settings_of_a_chain(wisp_bank* bank) {
  wisp_chain_settings settings;
  settings.size = sizeof settings;
  EXPECT(wisp_bank_get_chain_settings(bank, &settings) == WISP_OK);
  EXPECT(!settings.has_ground);
  EXPECT(wisp_bank_set_ground(bank, -2) == WISP_OK);
  EXPECT(wisp_bank_get_chain_settings(bank, &settings) == WISP_OK);
  EXPECT(settings.has_ground && settings.ground == -2);
  EXPECT(wisp_bank_clear_ground(bank) == WISP_OK);
  EXPECT(wisp_bank_get_chain_settings(bank, &settings) == WISP_OK);
  EXPECT(!settings.has_ground);
  EXPECT_FAILURE(wisp_bank_set_ground(bank, INFINITY), WISP_BAD_ARGUMENT, "not finite");
  EXPECT_FAILURE(wisp_bank_set_ground(NULL, 1), WISP_BAD_ARGUMENT, "null pointer");
  EXPECT_FAILURE(wisp_bank_get_chain_settings(bank, NULL), WISP_BAD_ARGUMENT, "null pointer");
  return NULL;
}

const char* leaf_in_the_world(const void* bytes, size_t size) {
  wisp_model* model = NULL;
  wisp_bank* bank = NULL;
  wisp_instance leaf = WISP_NO_INSTANCE;
  wisp_chain_place place;
  wisp_body body;
  float pose[7], noise = -1;
  const float gust[3] = {1, 0, 0};
  const char* wrong;
  int step;
  EXPECT(wisp_model_load(bytes, size, &model) == WISP_OK);
  EXPECT(wisp_bank_create(model, NULL, &bank) == WISP_OK);
  wisp_model_free(model);
  EXPECT(wisp_bank_spawn(bank, &leaf) == WISP_OK);
  place.size = sizeof place;
  EXPECT(wisp_bank_get_chain_place(bank, leaf, &place) == WISP_OK);
  EXPECT(place.segment < 3 && place.mode == (place.segment == 2 ? 1u : 0u));
  EXPECT_FAILURE(wisp_bank_get_chain_place(bank, WISP_NO_INSTANCE, &place), WISP_NOT_ALIVE, "not alive");
  memset(&body, 0, sizeof body);
  body.size = sizeof body;
  body.position[0] = 5;
  body.position[2] = 1;
  body.orientation[0] = 1;
  EXPECT(wisp_bank_place(bank, leaf, &body) == WISP_OK);
  EXPECT(wisp_bank_instance_outputs(bank, leaf, pose, 7) == WISP_OK);
  EXPECT(fabsf(pose[0] - 5) < 1e-4f && fabsf(pose[2] - 1) < 1e-4f);
  EXPECT(wisp_bank_set_common_inputs(bank, gust, 3) == WISP_OK);
  for (step = 0; step < 60; ++step) EXPECT(wisp_bank_step(bank) == WISP_OK);
  EXPECT(wisp_bank_instance_outputs(bank, leaf, pose, 7) == WISP_OK && pose[0] > 5.5f && pose[2] < 1);
  body.velocity[1] = nanf("");
  EXPECT_FAILURE(wisp_bank_place(bank, leaf, &body), WISP_BAD_ARGUMENT, "not finite");
  EXPECT_FAILURE(wisp_bank_place(bank, WISP_NO_INSTANCE, &body), WISP_NOT_ALIVE, "not alive");
  EXPECT_FAILURE(wisp_bank_place(bank, leaf, NULL), WISP_BAD_ARGUMENT, "null pointer");
  body.size = 16; /* a caller that knows of the position alone */
  EXPECT(wisp_bank_place(bank, leaf, &body) == WISP_OK);
  EXPECT(wisp_bank_set_noise(bank, 0.25f) == WISP_OK);
  EXPECT(wisp_bank_get_noise(bank, &noise) == WISP_OK && noise == 0.25f);
  wrong = settings_of_a_chain(bank);
  wisp_bank_free(bank);
  return wrong;
}

/* Noise through a low-pass, as wind rumbles at a microphone. */
static void blow(float* samples, size_t count, float level, uint32_t* state) {
  float slow = 0;
  size_t k;
  for (k = 0; k < count; ++k) {
    float chance;
    *state = *state * 1664525u + 1013904223u;
    chance = (float)((int32_t)*state >> 8) / 8388608.0f;
    slow += 0.05f * (chance - slow);
    samples[k] = level * slow + 0.0005f * chance;
  }
}

const char* wind_in_c(void) {
  enum { kRate = 48000, kFrames = 60 };
  static float samples[kRate];
  static int16_t words[kRate];
  wisp_wind_options options = wisp_wind_default_options();
  wisp_wind *wind = NULL, *twin = NULL;
  wisp_wind_frame frames[kFrames], latest, again[kFrames];
  wisp_wind_calibration known;
  size_t taken = 0, made = 0, k;
  uint32_t state = 1;
  EXPECT(options.size == sizeof options && options.rate_hz == 44100 && options.frame_rate_hz == 60);
  options.rate_hz = kRate;
  EXPECT(wisp_wind_create(&options, &wind) == WISP_OK && wisp_wind_create(&options, &twin) == WISP_OK);
  EXPECT(wisp_wind_latency(wind) >= 0 && wisp_wind_latency(wind) < 0.05);
  EXPECT(wisp_wind_latest(wind, &latest) == WISP_OK && latest.rms == 0);
  EXPECT(wisp_wind_calibrate(wind, WISP_WIND_BREATHE_GENTLY, 1) == WISP_OK && wisp_wind_calibrating(wind) == 1);
  blow(samples, kRate, 0, &state);
  EXPECT(wisp_wind_feed(wind, samples, kRate, frames, kFrames, &taken, &made) == WISP_OK);
  EXPECT(taken == kRate && made == kFrames && wisp_wind_calibrating(wind) == 0);
  EXPECT(wisp_wind_calibrated(wind) == 0 && wisp_wind_room_rise(wind) < 1); /* nobody breathed */
  EXPECT(wisp_wind_calibrate(wind, WISP_WIND_BLOW_HARD, 1) == WISP_OK && wisp_wind_calibrating(wind) == 1);
  EXPECT(wisp_wind_calibrate(wind, 2, 1) == WISP_BAD_ARGUMENT);
  EXPECT(frames[59].index == 59 && frames[59].wind < 0.01f);

  blow(samples, kRate, 2, &state);
  EXPECT(wisp_wind_feed(wind, samples, kRate, frames, 20, &taken, &made) == WISP_OK); /* no room for all */
  EXPECT(made == 20 && taken < kRate);
  EXPECT(wisp_wind_feed(wind, samples + taken, kRate - taken, frames + 20, 40, NULL, &made) == WISP_OK && made == 40);
  EXPECT(frames[59].wind > 0.3f && frames[59].confidence > 0.5f);
  EXPECT(wisp_wind_latest(wind, &latest) == WISP_OK && memcmp(&latest, &frames[59], sizeof latest) == 0);

  known.size = sizeof known;
  EXPECT(wisp_wind_get_calibration(wind, &known) == WISP_OK && known.gust_rms > 0);
  EXPECT(wisp_wind_set_calibration(twin, &known) == WISP_OK);
  EXPECT(wisp_wind_reset(wind) == WISP_OK && wisp_wind_set_calibration(wind, &known) == WISP_OK);
  for (k = 0; k < kRate; ++k) {
    words[k] = (int16_t)(samples[k] * 32767);
    samples[k] = words[k] / 32768.0f;
  }
  EXPECT(wisp_wind_feed(wind, samples, kRate, frames, kFrames, NULL, NULL) == WISP_OK);
  EXPECT(wisp_wind_feed_int16(twin, words, kRate, again, kFrames, &taken, &made) == WISP_OK);
  EXPECT(taken == kRate && made == kFrames && memcmp(frames, again, sizeof frames) == 0);
  wisp_wind_free(wind);
  wisp_wind_free(twin);
  return NULL;
}

const char* misuse_of_wind(void) {
  wisp_wind* wind = NULL;
  wisp_wind_options options = wisp_wind_default_options();
  wisp_wind_calibration known;
  wisp_wind_frame frame;
  float samples[4] = {0};
  size_t taken = 7, made = 7;
  options.rate_hz = 100;
  EXPECT_FAILURE(wisp_wind_create(&options, &wind), WISP_BAD_ARGUMENT, "100");
  options.rate_hz = nan("");
  EXPECT(wisp_wind_create(&options, &wind) == WISP_BAD_ARGUMENT);
  options = wisp_wind_default_options();
  options.channels = 0xffffffffu;
  EXPECT_FAILURE(wisp_wind_create(&options, &wind), WISP_BAD_ARGUMENT, "channel");
  options.size = 0;
  EXPECT_FAILURE(wisp_wind_create(&options, &wind), WISP_BAD_ARGUMENT, "set it to sizeof");
  EXPECT_FAILURE(wisp_wind_create(NULL, NULL), WISP_BAD_ARGUMENT, "null pointer");
  EXPECT(wind == NULL);
  options.size = 8; /* a caller that knows of no field but the channels */
  options.channels = 2;
  EXPECT(wisp_wind_create(&options, &wind) == WISP_OK);
  EXPECT_FAILURE(wisp_wind_feed(wind, samples, 3, &frame, 1, &taken, &made), WISP_BAD_ARGUMENT, "the 2 channels");
  EXPECT_FAILURE(wisp_wind_feed(wind, NULL, 2, &frame, 1, NULL, NULL), WISP_BAD_ARGUMENT, "null pointer");
  EXPECT_FAILURE(wisp_wind_feed(wind, samples, 4, NULL, 1, NULL, NULL), WISP_BAD_ARGUMENT, "null pointer");
  EXPECT_FAILURE(wisp_wind_feed_int16(NULL, NULL, 0, NULL, 0, NULL, NULL), WISP_BAD_ARGUMENT, "null pointer");
  EXPECT(taken == 7 && made == 7);
  EXPECT(wisp_wind_feed(wind, NULL, 0, NULL, 0, &taken, &made) == WISP_OK && taken == 0 && made == 0);
  samples[0] = nanf("");
  samples[1] = INFINITY;
  EXPECT(wisp_wind_feed(wind, samples, 4, &frame, 1, &taken, &made) == WISP_OK && taken == 4);
  EXPECT_FAILURE(wisp_wind_calibrate(wind, 0, nan("")), WISP_BAD_ARGUMENT, "not a number");
  EXPECT_FAILURE(wisp_wind_calibrate(NULL, 0, 1), WISP_BAD_ARGUMENT, "null pointer");
  known.size = sizeof known;
  EXPECT(wisp_wind_get_calibration(wind, &known) == WISP_OK);
  known.background_rms = -1;
  EXPECT_FAILURE(wisp_wind_set_calibration(wind, &known), WISP_BAD_ARGUMENT, "no room has");
  known.background_rms = nanf("");
  EXPECT_FAILURE(wisp_wind_set_calibration(wind, &known), WISP_BAD_ARGUMENT, "no room has");
  EXPECT(wisp_wind_room_rise(NULL) == 0);
  EXPECT(wisp_wind_calibrated(NULL) == 0);
  EXPECT(wisp_wind_calibrating(NULL) == 0 && wisp_wind_latency(NULL) == 0);
  wisp_wind_free(wind);
  wisp_wind_free(NULL);
  return NULL;
}

const char* cut_at_each_length(const void* bytes, size_t size) {
  wisp_model* model = NULL;
  size_t length;
  for (length = 0; length < size; ++length) {
    /* A copy of just that length, so that a sanitizer sees a byte read too many. */
    void* copy = malloc(length + 1);
    const wisp_status status = (memcpy(copy, bytes, length), wisp_model_load(copy, length, &model));
    free(copy);
    EXPECT(status == WISP_BAD_DATA && wisp_last_error()[0] != 0);
  }
  EXPECT(model == NULL);
  return NULL;
}
