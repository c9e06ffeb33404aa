#pragma once
// How the long checks take a result: their data are their own, so an error in them is a defect.

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "wisp/base/result.hpp"

namespace wisp::verify {

/// The value; prints the error and ends the program where there is none.
template <class T>
T value_or_abort(Result<T> result) {
  if (!result) {
    std::fprintf(stderr, "%s\n", result.error().message.c_str());
    std::abort();
  }
  return *std::move(result);
}

}  // namespace wisp::verify
