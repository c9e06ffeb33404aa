#pragma once
// Check of sampling rates: a discrete-time model is a different system at another rate.

#include <cmath>

#include "record/number_text.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Checks that a recording has the model's rate. Errors: it has another.
inline Result<void> check_rate(const Model& model, const Recording& recording) {
  constexpr double kSame = 1e-3;  // relative tolerance: clocks and rounded periods differ by less
  if (std::abs(recording.rate_hz - model.rate_hz) <= kSame * model.rate_hz) return {};
  return Error{recording.source + ": has " + number_text(recording.rate_hz, 6) + " samples a second, the model " +
               number_text(model.rate_hz, 6) + ": resample the recording, or learn the model at that rate"};
}

}  // namespace wisp
