#pragma once
// ARX estimation by least squares, with the figures that say how good the estimate is.
//
// Source: L. Ljung, System Identification: Theory for the User (2nd ed.), sections 4.2 (model), 7.3 (least squares),
// 9.3–9.4 (covariance of the estimate), 16.4 (FPE, AIC). Every output row is its own regression. Departures: rows with
// a missing sample are left out one by one, and an unstable estimate is made stable (section 7.3 has no such step).
// Equations and conventions: docs/explanation/identification.md.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "learn/arx/rows/arx_design.hpp"
#include "learn/arx/rows/arx_rows.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/arx_recipe.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

/// How to fit.
struct ArxOptions {
  ArxOrders orders;                     ///< see make_orders
  ArxOffset offset = ArxOffset::kMean;  ///< a linear model describes deviations from an operating point
  ArxKernel kernel = ArxKernel::kNone;  ///< a prior on every output's coefficients, found by its marginal likelihood
  std::vector<int> kernel_outputs{};    ///< outputs that have the prior; empty: all
  std::vector<int> integrators{};       ///< poles per output that are held where it integrates, 0 to 2; empty: none.
                                        ///< Only of outputs that remember no other output
  double integrator_pole = 1;           ///< where they are held
  bool stabilise = true;                ///< draw the poles of an unstable estimate inwards until it is stable
  double stability_margin = 1e-3;       ///< in (0, 1): a repaired model's spectral radius is at most 1 − this
  bool covariance = false;              ///< compute the covariance of all coefficients together, for confidence bands
  bool judge_free_run = true;           ///< simulate over the recordings too, to warn where one-step fit hides failure
};

/// A coefficient that the data cannot tell: its regressor is (nearly) a combination of others. It is set to 0.
struct RankProblem {
  int row = 0;          ///< output row
  std::string channel;  ///< whose lag
  int lag = 0;
  std::string reason;  ///< one sentence, with the channels and lags that it depends on
};

/// The outcome of the check of stability.
struct ArxStability {
  double radius = 0;       ///< of the model as returned, rounded to single precision
  bool changed = false;    ///< whether the estimate had to be changed
  double estimated = 0;    ///< radius of the unconstrained estimate
  double loss_factor = 1;  ///< geometric mean over outputs of one-step loss with the change / loss without
  double moved = 0;        ///< largest change of a coefficient that stability alone needs, in its standard errors
};

/// How good the fit is, and what happened. Figures are those of the model as returned.
struct ArxSummary {
  std::vector<double> loss;              ///< V: mean squared residual per output over the rows used, output's unit²
  std::vector<double> noise_covariance;  ///< ny × ny, row-major: mean products of residuals over the rows used
  double fpe = 0;        ///< det(noise covariance)·(1 + d/n)/(1 − d/n), d = mean number of coefficients of an output
  double fpe_total = 0;  ///< the same with d = d_total, the coefficients of all outputs together, as MATLAB counts
  double aic = 0;        ///< n ln det(noise covariance) + 2 d_total
  double aicc = 0;       ///< aic + 2 d_total (d_total + 1)/(n − d_total − 1)
  double bic = 0;        ///< n ln det(noise covariance) + d_total ln n
  std::vector<double> row_fpe;               ///< V·(1 + d/n)/(1 − d/n) per output row with its own d
  std::vector<double> fit_percent;           ///< one step ahead, 100(1 − ‖y − ŷ‖/‖y − ȳ‖) per output
  std::vector<double> free_run_fit_percent;  ///< the same for free simulation from the input; empty without inputs
  std::vector<double> played_fit_percent;    ///< the same of the stored model in single precision, as it is played
  std::vector<double> condition;             ///< 2-norm condition number of every row's regressor, in the data's units
  std::vector<RankProblem> rank_problems;
  ArxStability stable;
  std::vector<double> effective;  ///< d per output: number of coefficients, or what a kernel leaves of it
  std::size_t samples_used = 0;   ///< n: rows in the regression
  int first_sample = 0;           ///< first row of an episode that was predicted, 0-based
  std::size_t episodes_used = 0;
  std::size_t episodes_skipped = 0;  ///< too short to predict a single row
  std::size_t rows_left_out = 0;     ///< because a sample in them or in their history is missing
  std::string method;                ///< which factorisation and why
  std::vector<std::string> warnings;
  Usable usable;
};

/// A model and what to think of it.
struct ArxFit {
  ArxModel model;
  ArxSummary summary;
  std::vector<double> covariance;  ///< of all rows' theta one after the other, d_total × d_total, row-major; or empty
};

/// Fits an ARX model to all episodes of all recordings together; no history crosses a gap.
/// Returns the model (means, coefficients, standard errors, noise) and its summary. A fit that cannot be trusted is
/// returned with `usable.verdict` false and the reason.
/// Errors: no recordings, a channel that a recording has not, orders of the wrong shape, rates that differ, more
/// coefficients than rows, delays longer than the data, infinite samples.
Result<ArxFit> fit_arx(std::span<const Recording> recordings, const ChannelChoice& channels, const ArxOptions& options);

/// Shapes and ranges of order matrices, against the channels named.
Result<void> check_orders(const ArxOrders& orders, const ChannelChoice& channels);

/// Shapes and ranges of the options, against the channels named.
Result<void> check_options(const ArxOptions& options, const ChannelChoice& channels);

/// Whether there are rows enough for the coefficients of every output.
Result<void> check_rows(const RowPlan& plan, const ArxDesign& design);

}  // namespace wisp
