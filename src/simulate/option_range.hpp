#pragma once
// Check of options against their ranges, with one clear sentence for a violation.

#include <initializer_list>
#include <string>

#include "wisp/base/result.hpp"

namespace wisp::flow {

struct OptionRange {
  const char* name;
  double value;
  double lowest;
  double highest;
};

/// Errors: the first value outside its range; NaN is outside every range.
inline Result<void> check_ranges(const char* whose, std::initializer_list<OptionRange> ranges) {
  for (const OptionRange& r : ranges)
    if (!(r.value >= r.lowest && r.value <= r.highest))
      return Error{std::string(whose) + ": " + r.name + " is " + std::to_string(r.value) + ", expected " +
                   std::to_string(r.lowest) + " to " + std::to_string(r.highest)};
  return {};
}

}  // namespace wisp::flow
