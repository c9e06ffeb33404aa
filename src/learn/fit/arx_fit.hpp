#pragma once
// ARX estimation by least squares, with figures on the quality of the estimate.
//
// Source: L. Ljung, System Identification: Theory for the User (2nd ed.), sections 4.2 (model), 7.3 (least squares),
// 9.3–9.4 (covariance of the estimate), 16.4 (FPE, AIC). Every output row is its own regression. Departures: rows with
// a missing sample are left out one by one, and an unstable estimate is made stable (section 7.3 has no such step).
// Equations and conventions: docs/explanation/identification.md.

#include <string>
#include <vector>

#include "learn/rows/arx_design.hpp"
#include "learn/rows/arx_rows.hpp"
#include "wisp/base/result.hpp"
#include "wisp/learn/arx_recipe.hpp"
#include "wisp/model/arx.hpp"
#include "wisp/model/model.hpp"
#include "wisp/record/recording.hpp"

namespace wisp {

struct ArxOptions {
  ArxOrders orders;                     ///< see make_orders
  ArxOffset offset = ArxOffset::kMean;  ///< subtracted operating point, as the model is linear in deviations from it
  ArxKernel kernel = ArxKernel::kNone;  ///< prior on outputs' coefficients, tuned by marginal likelihood
  std::vector<int> kernel_outputs{};    ///< outputs with the prior; empty: all
  std::vector<int> integrators{};       ///< poles per output fixed at integrator_pole, 0 to 2; empty: none. Allowed for
                                        ///< outputs without lags of other outputs
  double integrator_pole = 1;           ///< z-plane position of the fixed poles
  bool stabilise = true;                ///< scale the poles of an unstable estimate inwards until it is stable
  double stability_margin = 1e-3;       ///< in (0, 1): maximum spectral radius of a stabilised model is 1 − this
  bool covariance = false;              ///< compute the covariance of all coefficients together, for confidence bands
  bool judge_free_run = true;           ///< also simulate the recordings, to warn of poor simulation
};

/// A coefficient that the data do not determine, set to 0: its regressor (nearly) depends linearly on others.
struct RankProblem {
  int row = 0;          ///< output row
  std::string channel;  ///< channel of its regressor, or "constant"
  int lag = 0;
  std::string reason;  ///< one sentence that names the channels and lags that the regressor depends on
};

struct ArxStability {
  double radius = 0;       ///< spectral radius of the returned model, rounded to single precision
  bool changed = false;    ///< whether the estimate had to be changed
  double estimated = 0;    ///< spectral radius of the unconstrained estimate
  double loss_factor = 1;  ///< loss after stabilisation / loss before, geometric mean over outputs
  double moved = 0;        ///< largest change of a coefficient by stabilisation alone, in its standard errors
};

/// Information criteria over n rows of residuals with covariance Λ, for c coefficients of all outputs together.
struct Criteria {
  double fpe = 0;        ///< det Λ (1 + d/n)/(1 − d/n), d = c / outputs
  double log_fpe = 0;    ///< ln FPE, which no unit makes overflow
  double fpe_total = 0;  ///< FPE with d = c, as in MATLAB
  double aic = 0;        ///< n ln det Λ + 2c
  double aicc = 0;       ///< aic + 2c (c + 1)/(n − c − 1); infinite where n <= c + 1
  double bic = 0;        ///< n ln det Λ + c ln n
};

/// Quality of the fit, warnings and verdict. Figures are those of the model as returned; the criteria are of its noise
/// covariance and effective numbers of coefficients.
struct ArxSummary : Criteria, RowCounts {
  std::vector<double> loss;              ///< V: mean squared residual per output over the rows used, output's unit²
  std::vector<double> noise_covariance;  ///< ny × ny, row-major: mean products of residuals over rows used
  std::vector<double> row_fpe;           ///< V·(1 + d/n)/(1 − d/n) per output row with d of that row
  std::vector<double> fit_percent;       ///< 100(1 − ‖y − ŷ‖/‖y − ȳ‖) one step ahead, per output
  std::vector<double> free_run_fit_percent;  ///< fit_percent of free simulation from the input; empty: not simulated
  std::vector<double> played_fit_percent;    ///< fit_percent of free simulation in single precision, as in play
  std::vector<double> condition;             ///< 2-norm condition number of each output row's regressors, data's units
  std::vector<RankProblem> rank_problems;
  ArxStability stable;
  std::vector<double> effective;  ///< d per output: number of coefficients, or the effective number under a kernel
  std::string method;             ///< name of the factorisation, and why it was chosen
  std::vector<std::string> warnings;
  Usable usable;
};

struct ArxFit {
  ArxModel model;
  ArxSummary summary;
  std::vector<double> covariance;  ///< of the concatenated thetas of all rows: d_total × d_total, row-major; or empty
};

/// Checks shapes and ranges of the order matrices for the given channels.
Result<void> check_orders(const ArxOrders& orders, const ChannelChoice& channels);

/// Checks shapes and ranges of the options for the given channels.
Result<void> check_options(const ArxOptions& options, const ChannelChoice& channels);

/// Checks that there are enough rows for the coefficients of every output.
Result<void> check_rows(const RowCounts& plan, const ArxDesign& design);

}  // namespace wisp
