#pragma once
// Curves on the inputs of an ARX model: a Hammerstein system, a static monotone curve with a linear system behind it.
//
// Source: L. Ljung, System Identification: Theory for the User (2nd ed.), section 5.2 (Hammerstein models); E.-W. Bai,
// Automatica 34 (1998), for the regression that is bilinear in the curve and in B. Here the curve is piecewise linear
// between knots, so that both halves of the alternation are least squares: B for a given curve, and for a given B the
// rises from knot to knot, none below 0 (Lawson and Hanson, 1974). A is eliminated from both, all sums are taken over
// the data once, and the alternation starts from the input and from its square. Outputs share the curve and are weighed
// by their residuals, taken as independent.

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "learn/arx/rows/channel_choice.hpp"
#include "wisp/base/result.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/model/input_curve.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// Input channels that one curve bends: an input, or the two sides of one whose sign is split.
struct CurvedInput {
  std::vector<std::string> channels;
  double lowest = 0;                                       ///< the curve's first knot: no sample lies below
  double highest = 0;                                      ///< its last
  double calm = -std::numeric_limits<double>::infinity();  ///< samples up to here do not count for where knots stand
};

/// How to fit.
struct CurveFitOptions {
  ArxOrders orders;
  std::vector<CurvedInput> inputs;
  int knots = 4;          ///< of every curve, both ends among them, 3 to kMaxCurveKnots
  int max_passes = 2000;  ///< of the alternation; it mostly ends within a hundred
};

/// A curve and how well it is known.
struct CurveEstimate {
  InputCurve curve;
  std::vector<double> std_error;  ///< of the value at every knot; 0 at both ends, which are fixed
};

/// The outcome.
struct CurveFit {
  std::vector<CurveEstimate> curves;  ///< one an input, in their order
  std::vector<double> loss;           ///< mean squared residual per output over the rows used, output's unit²
  std::size_t samples_used = 0;
  int passes = 0;
  bool converged = true;  ///< false: the alternation ended by its number of passes
};

/// Knots of a curve: the ends, and between them quantiles of what is neither calm nor at an end. Fewer than were asked
/// for where samples take few values.
std::vector<double> curve_knots(std::span<const Recording> recordings, const CurvedInput& input, int knots);

/// Fits the curves, about the means of all channels; no history crosses a gap.
/// Errors: as fit_arx; knots out of range; an input that takes too few values to tell a curve from a line.
Result<CurveFit> fit_input_curves(std::span<const Recording> recordings, const ChannelChoice& channels,
                                  const CurveFitOptions& options);

/// The recording with its inputs bent by their curves, one curve an input. An ARX model of that is the linear half.
///
/// Precondition: the recording has the channels.
Recording with_curves(Recording recording, std::span<const CurvedInput> inputs, std::span<const InputCurve> curves);

}  // namespace wisp
