#pragma once
// ARX models whose residual is coloured: A(q) y = B(q) u + v with v = e/D(q) (ARARX) or v = C(q) e (ARMAX), e white.
//
// Source: L. Ljung, System Identification: Theory for the User (2nd ed.), sections 4.2 (the models), 7.2 (prediction
// errors), 10.2 (Gauss and Newton's search with step halving), 9.3 (covariance). Generalised least squares for the one
// and extended least squares for the other minimise, or approach, the same criterion; the search starts from least
// squares and takes both to its minimum, so that standard errors hold. Every output row has a noise filter of its own.

#include <span>
#include <string_view>
#include <vector>

#include "wisp/base/result.hpp"
#include "wisp/learn/channel_choice.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// What colours the residual.
enum class NoiseColour {
  kWhite,           ///< nothing: ARX
  kAutoregressive,  ///< v = e/D: ARARX
  kMovingAverage,   ///< v = C e: ARMAX
};

/// A noise model: a colour and how many coefficients it has.
struct NoiseModel {
  NoiseColour colour = NoiseColour::kWhite;
  int order = 0;  ///< 1 to 64; 0 where white

  friend bool operator==(const NoiseModel&, const NoiseModel&) = default;
};

/// Reads `white`, `ar:N` or `ma:N`.
/// Errors: anything else, N out of range.
Result<NoiseModel> parse_noise_model(std::string_view text);

/// How to fit.
struct ColouredArxOptions {
  ArxOrders orders;  ///< of A and B
  NoiseModel noise;
  int most_passes = 60;  ///< of the search, 1 to 1000; it mostly ends within ten
};

/// A model with its noise filter.
struct ColouredArx {
  ArxModel model;  ///< A, B about the means of the recordings; its noise.sd is that of e
  NoiseModel noise;
  std::vector<std::vector<double>> filter;            ///< per output: coefficients of D or C after the leading 1
  std::vector<std::vector<double>> filter_std_error;  ///< the same shape
};

/// The outcome.
struct ColouredArxFit {
  ColouredArx model;
  std::vector<double> loss;  ///< mean e² per output
  std::size_t samples_used = 0;
  int passes = 0;         ///< the most that an output took
  bool converged = true;  ///< false: an output's search ended by its number of passes
};

/// Fits by prediction errors; no history crosses a gap, a filter starts from rest after it.
/// Errors: no recordings, a channel that a recording has not, orders or options out of range, fewer rows than
/// coefficients, regressors of which one is a combination of others.
Result<ColouredArxFit> fit_coloured_arx(std::span<const Recording> recordings, const ChannelChoice& channels,
                                        const ColouredArxOptions& options);

/// Mean log-likelihood of a recorded row, all outputs together and taken as independent, in nats: what held-out
/// recordings are compared by.
/// Errors: a channel that a recording has not, no row that can be predicted.
Result<double> log_likelihood(const ColouredArx& model, std::span<const Recording> recordings,
                              const ChannelChoice& channels);

/// The same model as ARX with a white residual, which is what is played live: D is multiplied into A and B; A and B are
/// divided by C, up to the lag beyond which every coefficient that is left out is below `smallest`, or `most_lags`.
///
/// Precondition: smallest > 0, most_lags >= 1.
ArxModel as_white(const ColouredArx& model, double smallest = 1e-4, int most_lags = 64);

}  // namespace wisp
