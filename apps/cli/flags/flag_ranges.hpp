#pragma once
// Ranges of numbers that flags take.

#include <span>

#include "command.hpp"

namespace wisp::cli {

/// What a flag's number may be, in the flag's own unit.
struct FlagRange {
  const char* flag;
  double lowest, highest;
};

/// Errors: the first of the flags whose number is outside its range. A flag that was not given, or that holds one of
/// its words (auto, none), is in range.
Result<void> check_ranges(const Arguments& arguments, std::span<const FlagRange> ranges);

}  // namespace wisp::cli
