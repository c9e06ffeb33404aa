#pragma once
// Whether the inputs of an ARX model are bent by curves, and of how many knots: by what was held out.
//
// Likelihoods are Student's with 5 degrees of freedom (K. Lange, R. Little & J. Taylor, J. Amer. Statist. Assoc. 84
// (1989)): residuals have tails, and in a Gaussian one a few frames would outweigh all others.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "learn/arx/curve/curve_fit.hpp"

namespace wisp {

/// Numbers of knots that are tried.
inline constexpr int kMinCurveKnots = 3;
inline constexpr int kMaxTriedKnots = 6;

/// A number of knots that was tried.
struct CurveCandidate {
  int knots = 0;
  double gain = 0;        ///< of the held-out log-likelihood over that without curves, nats a row
  double gain_error = 0;  ///< its standard error over blocks of rows; infinite where nothing could be told
};

/// What was chosen, and why.
struct CurveChoice {
  std::vector<CurveCandidate> candidates;
  int knots = 0;  ///< 0: no curves. Else that of the largest gain, which is more than two of its standard errors
  std::string reason;
};

/// Learns with and without curves and judges both one step ahead on what is held out, outputs taken as independent.
/// `knots` unset: 3 to 6 are tried; else that number is taken whatever its gain.
/// Errors: as fit_input_curves(), but where the number is open, inputs that take too few values and recordings that are
/// too short have no curve.
Result<CurveChoice> choose_input_curves(std::span<const Recording> learned, std::span<const Recording> held_out,
                                        const ChannelChoice& channels, const CurveFitOptions& options,
                                        std::optional<int> knots);

/// The log-likelihood of every row of the held-out recordings under a linear model learned from `learned` with its
/// inputs bent by the curves (none: as they are); NaN where a row can't be predicted.
/// Errors: as fit_arx() and predict().
Result<std::vector<double>> held_out_log_likelihood(std::span<const Recording> learned,
                                                    std::span<const Recording> held_out, const ChannelChoice& channels,
                                                    const CurveFitOptions& options, std::span<const InputCurve> curves);

}  // namespace wisp
