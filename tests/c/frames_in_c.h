/* Lives of 100 000 frames, and what a microphone hears, each as a hash: the same natively and in WebAssembly, where
 * bindings/npm/tests/bits.test.mjs does the same through the same ABI. Nothing here needs a mathematical library. */
#ifndef WISP_TESTS_FRAMES_IN_C_H
#define WISP_TESTS_FRAMES_IN_C_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Each sets hash[2] and returns NULL, or says what failed. */

/* Two instances of a model in wind that changes every seventh frame, through saving, restoring and relighting. */
const char* hash_of_life(const void* bytes, size_t size, uint32_t frames, uint32_t hash[2]);

/* Half-second gusts that rumble over a soft hiss, 48 kHz, 60 frames a second. */
const char* hash_of_wind(uint32_t seconds, uint32_t hash[2]);

#ifdef __cplusplus
}
#endif

#endif
