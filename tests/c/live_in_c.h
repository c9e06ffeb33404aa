/* What the C ABI has for live use, from C: a model's account of itself, chains, the wind of a microphone. Each returns
 * NULL when all is well, else what was not. */
#ifndef WISP_TESTS_LIVE_IN_C_H
#define WISP_TESTS_LIVE_IN_C_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A flame of 8 control points and a leaf, as in tests/c/models. */
const char* account_of_a_flame(const void* bytes, size_t size);
const char* account_of_a_leaf(const void* bytes, size_t size);
const char* leaf_in_the_world(const void* bytes, size_t size);

const char* wind_in_c(void);
const char* misuse_of_wind(void);

/* Every length of a model short of the whole is told as bad data. */
const char* cut_at_each_length(const void* bytes, size_t size);

#ifdef __cplusplus
}
#endif

#endif
