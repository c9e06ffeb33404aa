// Source: L. Ljung, System Identification (2nd ed.), section 16.4; C. Hurvich and C.-L. Tsai, Biometrika 76 (1989), for
// the correction of AIC to small samples.

#include "learn/arx/fit/arx_criteria.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace wisp {
namespace {

// ln det by way of correlations, so that units do not over- or underflow it.
double log_determinant(std::span<const double> covariance, int outputs) {
  const auto at = [&](int i, int j) { return covariance[static_cast<std::size_t>(i) * outputs + j]; };
  if (outputs == 1) return std::log(at(0, 0));
  Eigen::MatrixXd correlation(outputs, outputs);
  double log = 0;
  for (int i = 0; i < outputs; ++i) {
    log += std::log(at(i, i));
    for (int j = 0; j < outputs; ++j) correlation(i, j) = at(i, j) / std::sqrt(at(i, i) * at(j, j));
  }
  return log + Eigen::LDLT<Eigen::MatrixXd>(correlation).vectorD().array().log().sum();
}

}  // namespace

Criteria criteria_of(std::span<const double> covariance, int outputs, double rows, double coefficients) {
  const double log_det = log_determinant(covariance, outputs);
  const double share = coefficients / outputs / rows;
  Criteria out;
  out.fpe = std::exp(log_det) * (1 + share) / (1 - share);
  out.fpe_total = std::exp(log_det) * (1 + coefficients / rows) / (1 - coefficients / rows);
  out.aic = rows * log_det + 2 * coefficients;
  const double left = rows - coefficients - 1;
  out.aicc =
      left > 0 ? out.aic + 2 * coefficients * (coefficients + 1) / left : std::numeric_limits<double>::infinity();
  out.bic = rows * log_det + coefficients * std::log(rows);
  return out;
}

}  // namespace wisp
