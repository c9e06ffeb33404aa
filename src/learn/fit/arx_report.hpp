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
struct FitFacts {
  ArxOptions options;
  int outputs = 0;
  std::vector<std::string> names;  ///< outputs, then inputs
  std::vector<double> offset;      ///< per channel
  std::vector<double> scale;       ///< per channel
  std::size_t rows = 0;
  int first_sample = 0;
  std::size_t episodes_used = 0;
  std::size_t episodes_skipped = 0;
  std::size_t rows_left_out = 0;
  double drawn_in = 1;  ///< share of the maximum stable radius to which unstable poles are scaled
};

struct Criteria {
  double fpe = 0;        ///< det Λ (1 + d/n)/(1 − d/n), d = coefficients / outputs
  double fpe_total = 0;  ///< FPE with d = coefficients
  double aic = 0;        ///< n ln det Λ + 2 coefficients
  double aicc = 0;       ///< aic + 2 c (c + 1)/(n − c − 1), c = coefficients; infinite where n <= c + 1
  double bic = 0;        ///< n ln det Λ + c ln n
};

/// Information criteria of residuals with covariance Λ (ny × ny, row-major) over n rows.
Criteria criteria_of(std::span<const double> covariance, int outputs, double rows, double coefficients);

/// Inverse of a channel's scale; 0 for the scale 0 of a constant channel.
inline double inverse_or_zero(double value) { return value == 0 ? 0.0 : 1.0 / value; }

/// The model, stabilised unless disabled, and its summary; judge_fit sets `usable`.
ArxFit report_fit(const FitFacts& facts, const ArxDesign& design, ArxEstimate estimate);

/// Derives warnings and the verdict from the summary's figures.
void judge_fit(const FitFacts& facts, ArxSummary& summary);

}  // namespace wisp
