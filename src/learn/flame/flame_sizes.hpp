#pragma once
// Decay and re-ignition as modes of a flame: how its size goes to nothing when it is blown out, and comes back when it
// is lit, learned from recordings in which that was seen.
//
// In both modes a bank's flame has dynamics of one number, its size s, that are ARX of the first order with a root at
// 1, s(t+1) = s(t) ∓ step / seconds, between 0 and 1: a ramp. What is learned is how long it takes.

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "learn/flame/blow_outs.hpp"
#include "wisp/base/result.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// The direction in which a size changes.
enum class SizeChange {
  kDecay,       ///< to nothing
  kReIgnition,  ///< from nothing
};

/// The size of the flame in every row, NaN where it has no outline: the square root of its control points' polygon's
/// area, which shrinks as the flame does, over the median of that while it burns. All are NaN where it never burns
/// undisturbed.
/// Errors: not a recording of an outline.
Result<std::vector<double>> flame_sizes(const Recording& recording, std::span<const BlowOut> blow_outs);

/// The sizes seen in one decay or re-ignition, row by row away from where the flame was not there.
struct SizeCurve {
  double rate_hz = 0;
  std::vector<double> size;
};

/// The curves of a recording's deaths, over 0.6 s before each, or of its lightings, over up to 2 s after each; `sizes`
/// are its flame_sizes(). Stretches that were not blown have none.
///
/// Precondition: sizes.size() == recording.rows().
std::vector<SizeCurve> size_curves(const Recording& recording, std::span<const double> sizes,
                                   std::span<const BlowOut> blow_outs, SizeChange change);

/// The size in a bank `row` rows away from nothing, where the whole change takes `seconds`. Dying begins with a step
/// from full size, so the remainder before the last step is a part of a step.
///
/// Precondition: rate_hz > 0, seconds >= 0.
double ramp_size(SizeChange change, double seconds, double rate_hz, std::size_t row);

/// Root mean square difference of curves from such a ramp, over all rows that have a size; 0 where there is none.
double ramp_error(SizeChange change, double seconds, std::span<const SizeCurve> curves);

/// A learned duration.
struct RampFit {
  double seconds = 0;
  std::array<double, 2> seconds_ci95{};  ///< from the spread of the curves (leaving out each in turn) and half a row
                                         ///< either way: nobody sees when between two rows a change begins
  std::size_t events = 0;                ///< curves that it was learned from
  double error = 0;                      ///< ramp_error() of them
};

/// The ramp that errs least, from one row to as long as the curves are. Nothing where there is no curve.
std::optional<RampFit> learn_ramp(SizeChange change, std::span<const SizeCurve> curves);

}  // namespace wisp
