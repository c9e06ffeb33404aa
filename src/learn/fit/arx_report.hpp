#pragma once
// Converts an estimate in scaled units to a model in the data's units, with a summary of its quality.
//
// Source: L. Ljung, System Identification (2nd ed.), section 16.4; C. Hurvich and C.-L. Tsai, Biometrika 76 (1989), for
// the correction of AIC to small samples.

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "learn/fit/arx_estimate.hpp"
#include "learn/fit/arx_fit.hpp"
#include "learn/rows/arx_design.hpp"

namespace wisp {

/// All facts about a fit except its estimate.
struct FitFacts : RowCounts {
  ArxOptions options;
  int outputs = 0;
  std::vector<std::string> names;  ///< outputs, then inputs
  std::vector<double> offset;      ///< per channel
  std::vector<double> scale;       ///< per channel
  double drawn_in = 1;             ///< share of the maximum stable radius to which unstable poles are scaled
};

/// Percent of fit below which the simulation is reported to diverge, without a figure.
inline constexpr double kDiverges = -1000;
std::string fit_text(double percent);

/// Index of each output row's first coefficient in the joint covariance; then, as last entry, the covariance's size.
std::vector<Eigen::Index> row_starts(const ArxModel& model);

/// Information criteria of residuals with covariance Λ (ny × ny, row-major) over n rows.
Criteria criteria_of(std::span<const double> covariance, int outputs, double rows, double coefficients);

/// Companion matrix of a set of outputs without coupling to other outputs: its eigenvalues are their poles.
Eigen::MatrixXd companion_of(const ArxModel& model, const std::vector<int>& outputs);

/// Where a group of coupled outputs has a pole beyond `max_radius`, scales all poles of the group by one factor, so
/// that the largest radius becomes share · max_radius. B and the constant move to their optimum for that A. `inverse`,
/// per output row: (XᵀX)⁻¹ of its regressors, laid out and scaled as in the model, with an estimated constant last.
///
/// This method was chosen on public data: least squares on the boundary of the stable set has the lower one-step loss
/// but the larger simulation error on unseen rows (docs/studies/identification.md).
///
/// Preconditions: 0 < max_radius < 1; one inverse per output row, positive semidefinite.
void make_stable(ArxModel& model, const std::vector<Eigen::MatrixXd>& inverse, double max_radius, double share = 1);

/// The model, stabilised unless disabled, and its summary; judge_fit sets `usable`.
ArxFit report_fit(const FitFacts& facts, const ArxDesign& design, ArxEstimate estimate);

/// Derives warnings and the verdict from the summary's figures.
void judge_fit(const FitFacts& facts, ArxSummary& summary);

}  // namespace wisp
