#pragma once
// Answer of a call: text, bytes and numbers, kept until the next call for the host to read in place.

#include <cstddef>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp::studio {

struct Answer {
  std::string text;  ///< JSON; after a failure the sentence with the reason
  std::vector<std::byte> bytes;
  std::vector<double> numbers;
};

/// Returns the module's only answer.
Answer& answer();

/// Return values of calls.
inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;
inline constexpr int kElsewhere = 2;  ///< failed: the other module is responsible

/// Clears the answer for a new call.
Answer& fresh();

/// Sets the answer's text to an error's message. Returns kFailed.
int fail(const Error& error);

}  // namespace wisp::studio
