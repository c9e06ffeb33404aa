#pragma once
// Least squares of a handful of coefficients, by the normal equations with a ridge: for well-scaled regressors only.

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace wisp {

class NormalEquations {
 public:
  explicit NormalEquations(std::size_t size) : size_(size), matrix_(size * size), right_(size) {}

  void add(const std::vector<double>& row, double value) {
    for (std::size_t i = 0; i < size_; ++i) {
      right_[i] += row[i] * value;
      for (std::size_t j = 0; j < size_; ++j) matrix_[i * size_ + j] += row[i] * row[j];
    }
  }

  /// The coefficients, with a ridge as a share of each diagonal element; what no row has is 0.
  std::vector<double> solved(double ridge) const {
    std::vector<double> a = matrix_, x = right_;
    for (std::size_t i = 0; i < size_; ++i)
      a[i * size_ + i] += ridge * a[i * size_ + i] + (a[i * size_ + i] == 0 ? 1 : 0);
    // Elimination without exchanges: the matrix is symmetric and positive definite.
    for (std::size_t k = 0; k < size_; ++k) {
      for (std::size_t i = k + 1; i < size_; ++i) {
        const double factor = a[i * size_ + k] / a[k * size_ + k];
        for (std::size_t j = k; j < size_; ++j) a[i * size_ + j] -= factor * a[k * size_ + j];
        x[i] -= factor * x[k];
      }
    }
    for (std::size_t k = size_; k-- > 0;) {
      for (std::size_t j = k + 1; j < size_; ++j) x[k] -= a[k * size_ + j] * x[j];
      x[k] /= a[k * size_ + k];
    }
    return x;
  }

 private:
  std::size_t size_;
  std::vector<double> matrix_;
  std::vector<double> right_;
};

}  // namespace wisp
