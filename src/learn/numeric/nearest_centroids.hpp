#pragma once
// The rounds of k-means, with Hamerly's bounds: a row whose distance to its own centroid is below the least that any
// other centroid can have is left where it is, unmeasured.

#include <cstddef>
#include <span>
#include <vector>

#include "learn/numeric/clustering.hpp"

namespace wisp {

struct Rows {
  const double* values;
  std::size_t count;
  std::size_t columns;

  const double* at(std::size_t row) const { return values + row * columns; }
};

inline double squared_distance(const double* a, const double* b, std::size_t columns) {
  // Two sums: additions that wait for one another are what this costs.
  double even = 0, odd = 0;
  std::size_t k = 0;
  for (; k + 1 < columns; k += 2) {
    const double x = a[k] - b[k], y = a[k + 1] - b[k + 1];
    even += x * x;
    odd += y * y;
  }
  if (k < columns) even += (a[k] - b[k]) * (a[k] - b[k]);
  return even + odd;
}

class NearestCentroids {
 public:
  NearestCentroids(const Rows& rows, std::vector<double> centroids);

  /// Assigns every row to its nearest centroid and moves each centroid to its rows' mean. Returns the sum of the
  /// squared movements.
  double round();

  /// Assigns once more, and measures.
  KMeans result(int rounds);

 private:
  void assign();
  void measure(std::size_t row);
  void move(std::size_t row, std::size_t to);
  void fill_empty();
  double shift();

  const Rows& rows_;
  std::size_t clusters_;
  std::vector<double> centroids_;
  std::vector<double> sums_;
  std::vector<std::size_t> sizes_;
  std::vector<std::uint16_t> cluster_;
  std::vector<double> upper_;  // ≥ distance to the own centroid
  std::vector<double> lower_;  // ≤ distance to every other
  std::vector<double> apart_;  // half the distance of each centroid to the next one
  bool first_ = true;
};

}  // namespace wisp
