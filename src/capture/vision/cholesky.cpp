#include "capture/vision/cholesky.hpp"

#include <algorithm>
#include <cmath>

namespace wisp {

bool cholesky(std::span<double> matrix, int n) {
  for (int i = 0; i < n; ++i) {
    double* row = matrix.data() + static_cast<std::ptrdiff_t>(i) * n;
    for (int j = 0; j <= i; ++j) {
      const double* other = matrix.data() + static_cast<std::ptrdiff_t>(j) * n;
      double sum = row[j];
      for (int k = 0; k < j; ++k) sum -= row[k] * other[k];
      if (j < i) {
        row[j] = sum / other[j];
      } else {
        if (!(sum > 0)) return false;
        row[i] = std::sqrt(sum);
      }
    }
  }
  return true;
}

void cholesky_solve(std::span<const double> factor, int n, std::span<double> b) {
  for (int i = 0; i < n; ++i) {
    const double* row = factor.data() + static_cast<std::ptrdiff_t>(i) * n;
    double sum = b[i];
    for (int k = 0; k < i; ++k) sum -= row[k] * b[k];
    b[i] = sum / row[i];
  }
  for (int i = n - 1; i >= 0; --i) {
    const double* row = factor.data() + static_cast<std::ptrdiff_t>(i) * n;
    b[i] /= row[i];
    for (int k = 0; k < i; ++k) b[k] -= row[k] * b[i];
  }
}

void cholesky_inverse(std::span<const double> factor, int n, std::span<double> inverse) {
  for (int column = 0; column < n; ++column) {
    // Row `column` serves as the right-hand side: the inverse is symmetric.
    const std::span<double> row = inverse.subspan(static_cast<std::size_t>(column) * n, n);
    std::fill(row.begin(), row.end(), 0.0);
    row[column] = 1;
    cholesky_solve(factor, n, row);
  }
}

}  // namespace wisp
