#pragma once
// A static curve on an input: what a wind does need not be proportional to it.
//
// A Hammerstein model is a curve on the input and a linear system behind it. The curve is piecewise linear between a
// few knots and never falls. It has no gain and no offset of its own, those are the system's: at its first and its last
// knot it is the input itself, and so it is beyond them.

#include <cstddef>
#include <string>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

/// Most knots of a curve.
inline constexpr std::size_t kMaxCurveKnots = 16;

/// A monotone, piecewise linear curve. Where an input's sign is split it belongs to either side alike: its first knot
/// is 0 then.
struct InputCurve {
  std::vector<double> at;     ///< knots, ascending, in the input's unit
  std::vector<double> value;  ///< the curve there, never falling, equal to `at` at both ends

  bool empty() const { return at.empty(); }

  friend bool operator==(const InputCurve&, const InputCurve&) = default;
};

/// The curve at an input; NaN stays NaN. An empty curve is the input itself.
double value_at(const InputCurve& curve, double input);

/// Checks a curve that is not empty: 2 to kMaxCurveKnots knots within [lowest, highest], none nearer to the next than
/// a millionth of the curve's length, finite values that never fall and are the knot's own at both ends. Errors say
/// which, what was found and what was expected.
Result<void> check(const InputCurve& curve, double lowest, double highest);

}  // namespace wisp
