#pragma once
// K-means: clusters rows of numbers so that the squared distances to K centroids are least.
//
// Sources: S. P. Lloyd (1982), alternation; D. Arthur & S. Vassilvitskii, greedy k-means++ (SODA 2007), starts.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "wisp/base/result.hpp"

namespace wisp {

struct KMeansOptions {
  int clusters = 6;  ///< 1 … rows, at most 65535
  std::uint64_t seed = 1;
};

struct KMeans {
  std::vector<double> centroids;       ///< clusters × columns
  std::vector<std::uint16_t> cluster;  ///< cluster of each row
  std::vector<std::size_t> sizes;      ///< rows per cluster; none is empty
  double inertia = 0;                  ///< sum of squared distances to the centroids
  int rounds = 0;                      ///< number of iterations of the best start
};

/// Clusters rows, which are stored consecutively. A cluster that becomes empty gets the row farthest from its centroid.
/// Errors: no rows, more clusters than rows, a number of clusters that is out of range.
///
/// Precondition: rows.size() is a multiple of columns, which is not 0; all values are finite.
Result<KMeans> k_means(std::span<const double> rows, std::size_t columns, const KMeansOptions& options);

/// Mean silhouette of at most `most` equally spaced rows: −1 … 1, high for compact, separated clusters (P. J. Rousseeuw
/// 1987). 0 for one cluster.
double silhouette(std::span<const double> rows, std::size_t columns, const KMeans& found, std::size_t most = 1000);

}  // namespace wisp
