#pragma once
// Check of every list of numbers in a model.

#include <cmath>
#include <span>
#include <string>

#include "wisp/base/result.hpp"

namespace wisp {

/// Errors: a number of values other than `expected`, or one that is not finite; `what` names the list.
inline Result<void> check_finite(std::span<const double> values, std::size_t expected, const std::string& what) {
  if (values.size() != expected) {
    return Error{what + " has " + std::to_string(values.size()) + " values, expected " + std::to_string(expected)};
  }
  for (double value : values) {
    if (!std::isfinite(value)) return Error{what + " holds a number that is not finite"};
  }
  return {};
}

}  // namespace wisp
