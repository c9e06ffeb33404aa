#pragma once
// Common parts of the C ABI: types behind its handles, error messages, structs of other versions, and exceptions.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>

#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/wisp.h"

// Attribute that checks format strings by C99's rules, which MinGW's default, its own printf, does not follow.
#if defined(__MINGW32__) && !defined(__clang__)
#define WISP_FORMAT __attribute__((format(gnu_printf, 2, 3)))
#elif defined(__GNUC__)
#define WISP_FORMAT __attribute__((format(printf, 2, 3)))
#else
#define WISP_FORMAT
#endif

struct wisp_model {
  wisp::Model model;
};

struct wisp_bank {
  wisp::Bank bank;
};

namespace wisp::c {

inline InstanceId id_of(wisp_instance instance) {
  return {static_cast<std::uint32_t>(instance), static_cast<std::uint32_t>(instance >> 32)};
}

inline wisp_instance instance_of(InstanceId id) {
  if (id.generation == 0) return WISP_NO_INSTANCE;
  return static_cast<wisp_instance>(id.generation) << 32 | id.slot;
}

/// Stores a message as this thread's last error. Returns `status`. Allocates nothing.
wisp_status fail(wisp_status status, const char* format, ...) WISP_FORMAT;
wisp_status fail(wisp_status status, const Error& error);

wisp_status null_argument(const char* function);
wisp_status not_alive(const char* function);

/// Checks that a buffer is not null and has `expected` values (`or_more`: at least); stores an error otherwise.
bool buffer_is_right(const char* function, const void* values, std::size_t found, std::size_t expected,
                     bool or_more = false);

/// Checks that an index is below a count; stores an error otherwise.
bool index_is_right(const char* function, std::uint32_t index, std::size_t count);

/// Checks the size field of a struct; stores an error otherwise.
bool size_is_right(const char* function, std::uint32_t size);

/// Checks that a handle and a struct are not null, and the struct's size; stores an error otherwise.
template <class Handle, class Struct>
bool struct_is_right(const char* function, const Handle* handle, const Struct* given) {
  if (handle && given) return size_is_right(function, given->size);
  null_argument(function);
  return false;
}

/// Runs a function; an exception becomes an error status. Without exceptions, lack of memory ends the program.
template <class Work>
wisp_status guarded(const char* function, Work work) {
#ifdef __cpp_exceptions
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return fail(WISP_NO_MEMORY, "%s found no memory", function);
  } catch (...) {
    return fail(WISP_BAD_DATA, "%s failed unexpectedly", function);
  }
#else
  static_cast<void>(function);
  return work();
#endif
}

/// Fills a struct of a caller compiled against an older or newer version of it; returns WISP_OK.
template <class Struct>
wisp_status hand_out(Struct filled, Struct* out) {
  filled.size = out->size;
  std::memcpy(out, &filled, std::min<std::size_t>(out->size, sizeof(Struct)));
  return WISP_OK;
}

/// Copies the fields that the caller of `given` knows into `known`, which holds the defaults.
template <class Struct>
void take_in(const Struct* given, Struct& known) {
  std::memcpy(&known, given, std::min<std::size_t>(given->size, sizeof known));
}

/// Fills an array, whose count must equal the number of values.
template <class Values, class Value>
wisp_status hand_out_values(const char* function, const Values& from, Value* values, std::size_t count) {
  if (!buffer_is_right(function, values, count, from.size())) return WISP_BAD_ARGUMENT;
  std::size_t k = 0;
  for (const auto& value : from) values[k++] = static_cast<Value>(value);
  return WISP_OK;
}

}  // namespace wisp::c
