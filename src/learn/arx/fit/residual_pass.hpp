#pragma once
// One pass over the data with given coefficients: products of the residuals with each other and with the regressors.

#include <Eigen/Core>
#include <vector>

#include "learn/arx/rows/arx_design.hpp"
#include "learn/arx/rows/arx_rows.hpp"

namespace wisp {

/// Coefficients of every group of rows: regressors × rows, in scaled units, without A's sign.
using GroupThetas = std::vector<Eigen::MatrixXd>;

struct ResidualProducts {
  Eigen::MatrixXd gram;  ///< ny × ny: Σ r_i r_j
  GroupThetas gradient;  ///< Σ x r, laid out as the coefficients
};

/// Residuals are computed from the data, row by row, so their products do not suffer from cancellation.
ResidualProducts residual_products(const Signals& signals, const RowPlan& plan, const ArxDesign& design,
                                   const GroupThetas& theta);

}  // namespace wisp
