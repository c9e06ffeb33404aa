#pragma once
// What a call answers with: a text, bytes and numbers, kept until the next call, for the host to read in place.

#include <cstddef>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp::studio {

struct Answer {
  std::string text;  ///< JSON; where the call failed the sentence that says why
  std::vector<std::byte> bytes;
  std::vector<double> numbers;
};

/// The one answer.
Answer& answer();

/// What a call returns.
inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;
inline constexpr int kElsewhere = 2;  ///< failed: the other module does it

/// Begins a new answer.
Answer& fresh();

/// Answers with the sentence.
int fail(const Error& error);

}  // namespace wisp::studio
