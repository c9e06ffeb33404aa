#pragma once
// What is known of an impulse response before any data: it dies down, and neighbours are alike. How fast and how much
// the data say, by the marginal likelihood.
//
// Source: T. Chen, H. Ohlsson, L. Ljung, Automatica 48 (2012), the TC kernel; G. Pillonetto et al., Automatica 50
// (2014), section 4.4 (empirical Bayes). With the kernel c·λ^max(i, j) the differences of neighbouring coefficients are
// independent (F. Carli, European Control Conference 2014), so that the prior's factor has two diagonals. Departure:
// the variance of the noise is maximised over in closed form instead of taken from another fit.

#include <Eigen/Core>
#include <vector>

namespace wisp::arx {

/// Neighbouring columns of a regression that are one channel's lags, in rising order.
struct KernelBlock {
  int first = 0;
  int size = 0;
};

/// A regression of one target, by products: XᵀX, Xᵀy, yᵀy, and the number of rows.
struct RegressionProducts {
  Eigen::MatrixXd gram;
  Eigen::VectorXd moment;
  double square = 0;
  double rows = 0;
};

/// F, so that |y − Xθ|² + |Fθ|² has its least at the posterior mean. Columns outside of all blocks are left free.
Eigen::MatrixXd kernel_factor(const RegressionProducts& products, const std::vector<KernelBlock>& blocks);

}  // namespace wisp::arx
