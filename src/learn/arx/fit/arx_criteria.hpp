#pragma once
// Criteria that weigh fit against the number of coefficients.

#include <span>

namespace wisp {

struct Criteria {
  double fpe = 0;        ///< det Λ (1 + d/n)/(1 − d/n), d = coefficients / outputs
  double fpe_total = 0;  ///< the same with d = coefficients
  double aic = 0;        ///< n ln det Λ + 2 coefficients
  double aicc = 0;       ///< aic + 2 c (c + 1)/(n − c − 1), c = coefficients; infinite where n <= c + 1
  double bic = 0;        ///< n ln det Λ + c ln n
};

/// Of residuals with covariance Λ (ny × ny, row-major) over n rows.
Criteria criteria_of(std::span<const double> covariance, int outputs, double rows, double coefficients);

}  // namespace wisp
