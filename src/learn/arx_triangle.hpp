#pragma once
// The regression reduced to a triangle: RᵀR is the Gram matrix of all columns and targets, found without forming it.
//
// Source: G. Golub & C. Van Loan, Matrix Computations (4th ed.), section 5.2; rows are taken in block by block
// (A. Björck, Numerical Methods for Least Squares Problems, section 6.2), so memory does not grow with the rows.

#include <Eigen/Core>
#include <span>

#include "arx_rows.hpp"

namespace wisp {

/// The upper triangle R of [regressors | outputs] over all rows of the plan, in scaled units. Regressors are in the
/// order of `columns`, without A's sign; outputs follow in their order.
Eigen::MatrixXd triangle_by_qr(const Signals& signals, const RowPlan& plan, std::span<const LaggedChannel> columns);

}  // namespace wisp
