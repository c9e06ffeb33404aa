/* How the C side of the tests says what was not as expected: a function returns the sentence, or NULL when all is well.
 */
#ifndef WISP_TESTS_EXPECT_IN_C_H
#define WISP_TESTS_EXPECT_IN_C_H

#include <string.h>

#include "wisp/wisp.h"

#define TEXT_OF(x) #x
#define TEXT(x) TEXT_OF(x)
#define EXPECT(condition)                                            \
  do {                                                               \
    if (!(condition)) return "line " TEXT(__LINE__) ": " #condition; \
  } while (0)

/* A failure must have the status, a sentence of its own, and the words in it. */
#define EXPECT_FAILURE(call, status, words)             \
  do {                                                  \
    EXPECT((call) == (status));                         \
    EXPECT(strstr(wisp_last_error(), (words)) != NULL); \
  } while (0)

#endif
