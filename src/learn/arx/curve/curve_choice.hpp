#pragma once
// Whether the inputs of an ARX model are bent by curves, and of how many knots: by free simulation of what was held
// out.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "learn/arx/curve/curve_fit.hpp"
#include "learn/arx/judge/held_out.hpp"

namespace wisp {

/// Numbers of knots that are tried.
inline constexpr int kMinCurveKnots = 3;
inline constexpr int kMaxTriedKnots = 6;

/// A number of knots that was tried.
struct CurveCandidate {
  int knots = 0;
  double gain = 0;  ///< share by which curves lower the root mean squared error of held-out free runs; below 0: raise
  double sureness = 0;  ///< of that, in standard errors over parts of the folds
};

/// What was chosen, and why.
struct CurveChoice {
  std::vector<CurveCandidate> candidates;
  int knots = 0;  ///< 0: no curves. Else those of the least error, which is less by two standard errors and more
  std::string reason;
};

/// Learns from every fold with and without curves and simulates freely what the fold holds out. `knots` unset: none and
/// 3 to 6 are tried; else that number is taken whatever its gain.
/// Errors: as fit_input_curves(), but where the number is open, inputs that take too few values and recordings that are
/// too short have no curve.
Result<CurveChoice> choose_input_curves(std::span<const arx::Fold> folds, const ChannelChoice& channels,
                                        const CurveFitOptions& options, std::optional<int> knots);

}  // namespace wisp
