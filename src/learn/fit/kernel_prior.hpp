#pragma once
// Prior for impulse responses: they decay and are smooth. Marginal likelihood chooses the decay and the scale from the
// data.
//
// Source: T. Chen, H. Ohlsson, L. Ljung, Automatica 48 (2012), the TC kernel; G. Pillonetto et al., Automatica 50
// (2014), section 4.4 (empirical Bayes). With the kernel c·λ^max(i, j) the differences of neighbouring coefficients are
// independent (F. Carli, European Control Conference 2014), so that the prior's factor has two diagonals. Departure:
// the noise variance is maximised over in closed form instead of taken from another fit.

#include <Eigen/Core>
#include <vector>

namespace wisp::arx {

/// Adjacent columns of a regression that hold one channel's lags, in rising order.
struct KernelBlock {
  int first = 0;
  int size = 0;
};

/// A regression of one target, as products: XᵀX, Xᵀy, yᵀy, and the number of rows.
struct RegressionProducts {
  Eigen::MatrixXd gram;
  Eigen::VectorXd moment;
  double square = 0;
  double rows = 0;
};

/// Returns F such that |y − Xθ|² + |Fθ|² is least at the posterior mean. Columns outside all blocks have no prior.
Eigen::MatrixXd kernel_factor(const RegressionProducts& products, const std::vector<KernelBlock>& blocks);

}  // namespace wisp::arx
