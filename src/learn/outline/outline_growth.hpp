#pragma once
// Noise whose size grows with the wind, where the data say so.
//
// The residual of output i at time t is taken to be as large as sd_i · s(t), s(t) = 1 + Σ growth_k · m_k(t), m_k the
// mean of the non-negative input u_k over the last quarter of a second (what a gust has stirred goes on when it is
// over), the same for all outputs: a gust shakes the whole outline. The growths are those of maximum likelihood, with
// every sd_i at its own maximum (multiplicative heteroscedasticity, A. C. Harvey, Econometrica 44 (1976), with a linear
// instead of an exponential law, so that the frame path needs no exponential), and they are kept only where what is
// held out becomes more likely by them. The likelihood is Student's with 5 degrees of freedom (K. Lange, R. Little & J.
// Taylor, J. Amer. Statist. Assoc. 84 (1989)): residuals have tails, and in a calm that was none since the microphone
// missed a gust, a single frame would outweigh all others in a Gaussian one.

#include <span>
#include <vector>

#include "learn/outline/outline_preparation.hpp"
#include "wisp/base/result.hpp"
#include "learn/outline/outline_fit.hpp"
#include "wisp/model/arx.hpp"

namespace wisp {

/// Estimates the growth from what `model` leaves of `learned`, its own recordings, and checks it on `held_out`.
/// Errors: as predict().
Result<OutlineNoiseGrowth> learn_noise_growth(const ArxModel& model, std::span<const Recording> learned,
                                              std::span<const Recording> held_out, const PreparedOutlines& prepared);

/// Growth for every regressor and lag of the model, as ResidualNoise holds it; empty where none is kept.
std::vector<double> growth_of_regressors(const OutlineNoiseGrowth& growth, const PreparedOutlines& prepared);

/// The mean of s² over all rows of which it is known: what the noise's variance gains by growing.
double mean_square_growth(const OutlineNoiseGrowth& growth, std::span<const Recording> recordings,
                          const PreparedOutlines& prepared);

}  // namespace wisp
