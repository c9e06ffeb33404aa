#pragma once
// The regression reduced to a triangle: RᵀR is the Gram matrix of all columns, found without forming it.
//
// Source: G. Golub & C. Van Loan, Matrix Computations (4th ed.), section 5.2; rows are taken in block by block
// (A. Björck, Numerical Methods for Least Squares Problems, section 6.2), so memory does not grow with the rows.

#include <Eigen/Core>

#include "learn/arx/rows/arx_rows.hpp"
#include "learn/numeric/lag_layout.hpp"

namespace wisp {

/// Reduces [triangle; rows of `matrix`] to `triangle`. `matrix` is used up.
void reduce_rows(Eigen::MatrixXd& triangle, const Eigen::MatrixXd& rows);

/// The upper triangle of all columns of the layout over all rows of the plan, in scaled units.
Eigen::MatrixXd triangle_by_qr(const Signals& signals, const RowPlan& plan, const LagLayout& layout);

}  // namespace wisp
