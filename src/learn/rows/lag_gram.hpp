#pragma once
// Reduces a regression on lagged channels to a square matrix: its Gram matrix, by few long products, or the triangle R
// with RᵀR the Gram matrix, computed from the rows (G. Golub & C. Van Loan, Matrix Computations (4th ed.), section 5.2;
// block by block: A. Björck, Numerical Methods for Least Squares Problems, section 6.2).
//
// Neighbouring rows of a regression on lags share nearly all numbers: the product of channel c at lag l with channel c′
// at lag l′ differs from their product at lags l−1 and l′−1 only at the two ends of the rows. So only products with a
// channel's first lag are summed over all rows, channels² × lags of them instead of (channels × lags)²; end corrections
// give the others along the diagonals. The structure is that of L. Ljung, System Identification (2nd ed.), section 10.1
// (covariance and autocorrelation method); the end terms are kept here, so the Gram matrix is exact but for rounding.

#include <Eigen/Core>

#include "learn/rows/arx_rows.hpp"

namespace wisp {

/// Pairs of channels whose products are needed: `wanted(c, c′)`, symmetric.
using ChannelPairs = Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic>;

/// Symmetric matrix of products of all columns of the layout over all rows of the plan, in scaled units. Products of
/// pairs that are not wanted are undefined.
Eigen::MatrixXd lag_gram(const Signals& signals, const RowPlan& plan, const LagLayout& layout,
                         const ChannelPairs& wanted);

/// Reduces [triangle; rows] to `triangle` by orthogonal transformations.
void reduce_rows(Eigen::MatrixXd& triangle, const Eigen::MatrixXd& rows);

/// Upper triangle R of all columns of the layout over all rows of the plan, in scaled units.
Eigen::MatrixXd triangle_by_qr(const Signals& signals, const RowPlan& plan, const LagLayout& layout);

}  // namespace wisp
