#pragma once
// Cholesky factors of small dense symmetric matrices, row-major, in place.

#include <span>

namespace wisp {

/// Replaces the lower triangle of the n × n matrix by its factor L with L Lᵀ = matrix. Returns false where the matrix
/// is not positive definite.
bool cholesky(std::span<double> matrix, int n);

/// Solves L Lᵀ x = b in place.
void cholesky_solve(std::span<const double> factor, int n, std::span<double> b);

/// The whole inverse of L Lᵀ into `inverse` (n × n).
void cholesky_inverse(std::span<const double> factor, int n, std::span<double> inverse);

}  // namespace wisp
