#pragma once
// K-means: rows of numbers into K clusters of least squared distance to their centroid.
//
// Sources: S. P. Lloyd (1982) for the alternation; D. Arthur & S. Vassilvitskii, k-means++ (SODA 2007), greedy variant,
// for the starts.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

struct KMeansOptions {
  int clusters = 6;  ///< 1 … rows
  std::uint64_t seed = 1;
};

struct KMeans {
  std::size_t columns = 0;
  std::vector<double> centroids;       ///< clusters × columns
  std::vector<std::uint16_t> cluster;  ///< per row
  std::vector<std::size_t> sizes;      ///< per cluster; none is empty unless rows coincide
  double inertia = 0;                  ///< sum of squared distances to the centroids
  int rounds = 0;                      ///< of the best start
};

/// Rows lie one after the other. A cluster that loses its last row is given the row farthest from its centroid.
/// Errors: no rows, more clusters than rows, a number of clusters that is out of range.
///
/// Precondition: rows.size() is a multiple of columns, which is not 0, and all are finite.
Result<KMeans> k_means(std::span<const double> rows, std::size_t columns, const KMeansOptions& options);

/// Mean silhouette of at most `most` rows, evenly spread: −1 … 1, high where clusters are tight and apart (P. J.
/// Rousseeuw 1987). 0 for one cluster.
double silhouette(std::span<const double> rows, std::size_t columns, const KMeans& found, std::size_t most = 1000);

}  // namespace wisp
