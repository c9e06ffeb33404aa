#include "learn/numeric/nearest_centroids.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wisp {

NearestCentroids::NearestCentroids(const Rows& rows, std::vector<double> centroids)
    : rows_(rows),
      clusters_(centroids.size() / rows.columns),
      centroids_(std::move(centroids)),
      sums_(centroids_.size()),
      sizes_(clusters_),
      cluster_(rows.count),
      upper_(rows.count),
      lower_(rows.count),
      apart_(clusters_) {}

void NearestCentroids::move(std::size_t row, std::size_t to) {
  const std::size_t from = cluster_[row];
  const double* x = rows_.at(row);
  if (!first_) {
    --sizes_[from];
    for (std::size_t k = 0; k < rows_.columns; ++k) sums_[from * rows_.columns + k] -= x[k];
  }
  ++sizes_[to];
  for (std::size_t k = 0; k < rows_.columns; ++k) sums_[to * rows_.columns + k] += x[k];
  cluster_[row] = static_cast<std::uint16_t>(to);
}

void NearestCentroids::measure(std::size_t row) {
  double least = std::numeric_limits<double>::max(), second = least;
  std::size_t nearest = 0;
  for (std::size_t k = 0; k < clusters_; ++k) {
    const double distance = squared_distance(rows_.at(row), &centroids_[k * rows_.columns], rows_.columns);
    if (distance < least) {
      second = least;
      least = distance;
      nearest = k;
    } else if (distance < second) {
      second = distance;
    }
  }
  upper_[row] = std::sqrt(least);
  lower_[row] = std::sqrt(second);
  if (first_ || nearest != cluster_[row]) move(row, nearest);
}

void NearestCentroids::assign() {
  for (std::size_t k = 0; k < clusters_; ++k) {
    double least = std::numeric_limits<double>::max();
    for (std::size_t other = 0; other < clusters_; ++other) {
      if (other == k) continue;
      least = std::min(
          least, squared_distance(&centroids_[k * rows_.columns], &centroids_[other * rows_.columns], rows_.columns));
    }
    apart_[k] = std::sqrt(least) / 2;
  }
  for (std::size_t row = 0; row < rows_.count; ++row) {
    if (!first_) {
      const std::size_t own = cluster_[row];
      const double bound = std::max(apart_[own], lower_[row]);
      if (upper_[row] <= bound) continue;
      upper_[row] = std::sqrt(squared_distance(rows_.at(row), &centroids_[own * rows_.columns], rows_.columns));
      if (upper_[row] <= bound) continue;
    }
    measure(row);
  }
  first_ = false;
  fill_empty();
}

void NearestCentroids::fill_empty() {
  for (std::size_t k = 0; k < clusters_; ++k) {
    if (sizes_[k] > 0) continue;
    std::size_t farthest = 0;
    double most = -1;
    for (std::size_t row = 0; row < rows_.count; ++row) {
      if (sizes_[cluster_[row]] < 2) continue;
      const double away = squared_distance(rows_.at(row), &centroids_[cluster_[row] * rows_.columns], rows_.columns);
      if (away <= most) continue;
      most = away;
      farthest = row;
    }
    move(farthest, k);
    upper_[farthest] = std::numeric_limits<double>::max();
    lower_[farthest] = 0;
  }
}

double NearestCentroids::shift() {
  double all = 0, most = 0, second = 0;
  std::size_t fastest = 0;
  std::vector<double> moved(clusters_);
  for (std::size_t k = 0; k < clusters_; ++k) {
    double square = 0;
    for (std::size_t column = 0; column < rows_.columns; ++column) {
      double& centroid = centroids_[k * rows_.columns + column];
      const double mean = sums_[k * rows_.columns + column] / static_cast<double>(sizes_[k]);
      square += (mean - centroid) * (mean - centroid);
      centroid = mean;
    }
    all += square;
    moved[k] = std::sqrt(square);
    if (moved[k] > most) {
      second = most;
      most = moved[k];
      fastest = k;
    } else {
      second = std::max(second, moved[k]);
    }
  }
  for (std::size_t row = 0; row < rows_.count; ++row) {
    const std::size_t own = cluster_[row];
    upper_[row] += moved[own];
    lower_[row] -= own == fastest ? second : most;
  }
  return all;
}

double NearestCentroids::round() {
  assign();
  return shift();
}

KMeans NearestCentroids::result(int rounds) {
  assign();
  KMeans out;
  out.columns = rows_.columns;
  for (std::size_t row = 0; row < rows_.count; ++row) {
    out.inertia += squared_distance(rows_.at(row), &centroids_[cluster_[row] * rows_.columns], rows_.columns);
  }
  out.centroids = centroids_;
  out.cluster = cluster_;
  out.sizes = sizes_;
  out.rounds = rounds;
  return out;
}

}  // namespace wisp
