#include "c/boundary.hpp"

#include <cstdarg>
#include <cstdio>

namespace wisp::c {
namespace {

// A fixed buffer, so that an error on the frame path allocates nothing.
thread_local char last_error[512] = "";

}  // namespace

wisp_status fail(wisp_status status, const char* format, ...) {
  va_list words;
  va_start(words, format);
  std::vsnprintf(last_error, sizeof last_error, format, words);
  va_end(words);
  return status;
}

wisp_status fail(wisp_status status, const Error& error) { return fail(status, "%s", error.message.c_str()); }

wisp_status null_argument(const char* function) {
  return fail(WISP_BAD_ARGUMENT, "%s was given a null pointer", function);
}

wisp_status not_alive(const char* function) {
  return fail(WISP_NOT_ALIVE, "%s was given an instance that is not alive", function);
}

bool buffer_is_right(const char* function, const void* values, std::size_t found, std::size_t expected, bool or_more) {
  if (!values && found + expected > 0) {
    null_argument(function);
    return false;
  }
  if (found == expected || (or_more && found > expected)) return true;
  fail(WISP_BAD_ARGUMENT, "%s was given room for %zu, expected %s%zu", function, found, or_more ? "at least " : "",
       expected);
  return false;
}

bool index_is_right(const char* function, std::uint32_t index, std::size_t count) {
  if (index < count) return true;
  fail(WISP_BAD_ARGUMENT, "%s was given index %u, expected less than %zu", function, static_cast<unsigned>(index),
       count);
  return false;
}

bool size_is_right(const char* function, std::uint32_t size) {
  if (size >= 2 * sizeof(std::uint32_t)) return true;
  fail(WISP_BAD_ARGUMENT, "%s was given a struct whose size field is %u: set it to sizeof", function,
       static_cast<unsigned>(size));
  return false;
}

}  // namespace wisp::c

extern "C" {

int32_t wisp_version(void) { return WISP_VERSION_MAJOR * 1000000 + WISP_VERSION_MINOR * 1000 + WISP_VERSION_PATCH; }

const char* wisp_last_error(void) { return wisp::c::last_error; }
}
