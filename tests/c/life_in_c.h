/* What the C side of the tests offers to the C++ side. */
#ifndef WISP_TESTS_LIFE_IN_C_H
#define WISP_TESTS_LIFE_IN_C_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Each returns NULL when all is well, else what was not. */

/* A whole life: load, spawn, blow, step, read, save, restore, end, free. `outputs` gets the outputs of 16 channels
 * after 50 steps with wind 0.5, of a bank with seed 3. */
const char* whole_life(const void* bytes, size_t size, float outputs[16]);

/* A bank in the caller's memory gives what one with its own gives. */
const char* life_in_given_memory(const void* bytes, size_t size);

/* Every misuse has its status and its sentence, and changes nothing. */
const char* misuse(const void* bytes, size_t size);

/* Structs of callers that know fewer fields, or more, than the library. */
const char* structs_of_other_sizes(const void* bytes, size_t size);

/* A flame of 30 steps a second with the default rule of extinction is blown out, stays out, is lit again and put out.
 */
const char* death_in_c(const void* bytes, size_t size);

#ifdef __cplusplus
}
#endif

#endif
