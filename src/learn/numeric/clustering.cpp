#include "learn/numeric/clustering.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <string>

namespace wisp {
namespace {

constexpr int kStarts = 10;      // random starts; the best one is taken
constexpr int kMaxRounds = 300;  // maximum number of iterations of a start
// A start ends where the squared movements of the centroids sum to at most this share of the variance. The best start
// is then iterated until no centroid moves, or kMaxRounds is reached.
constexpr double kTolerance = 1e-4;

struct Rows {
  const double* values;
  std::size_t count;
  std::size_t columns;

  const double* at(std::size_t row) const { return values + row * columns; }
};

double squared_distance(const double* a, const double* b, std::size_t columns) {
  // Two sums, so that additions need not wait for each other's results.
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

double unit_interval(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

// Index of the first row at which the cumulative sum of weights exceeds a random share of the total.
std::size_t drawn_row(const std::vector<double>& weights, double total, std::mt19937_64& random) {
  double left = unit_interval(random) * total;
  for (std::size_t row = 0; row < weights.size(); ++row) {
    left -= weights[row];
    if (left < 0) return row;
  }
  return weights.size() - 1;
}

// Updates squared distances to the nearest centroid with row `to` as a further centroid; returns their sum.
double nearer(const Rows& rows, std::size_t to, const std::vector<double>& before, std::vector<double>& out) {
  double sum = 0;
  for (std::size_t row = 0; row < rows.count; ++row) {
    out[row] = std::min(before[row], squared_distance(rows.at(row), rows.at(to), rows.columns));
    sum += out[row];
  }
  return sum;
}

// Greedy k-means++: draws a few rows in proportion to their squared distance and keeps the row that leaves the smallest
// sum of squared distances.
std::vector<double> start_centroids(const Rows& rows, int clusters, std::mt19937_64& random) {
  const int trials = 2 + static_cast<int>(std::log(static_cast<double>(clusters)));
  std::vector<double> centroids, distance(rows.count, std::numeric_limits<double>::max());
  std::vector<double> tried(rows.count), best(rows.count);
  const auto take = [&](std::size_t row) {
    centroids.insert(centroids.end(), rows.at(row), rows.at(row) + rows.columns);
  };
  const std::size_t first = random() % rows.count;
  take(first);
  double total = nearer(rows, first, distance, best);
  distance.swap(best);
  for (int k = 1; k < clusters; ++k) {
    double least = std::numeric_limits<double>::max();
    std::size_t chosen = 0;
    for (int trial = 0; trial < trials; ++trial) {
      const std::size_t row = drawn_row(distance, total, random);
      const double sum = nearer(rows, row, distance, tried);
      if (sum >= least) continue;
      least = sum;
      chosen = row;
      best.swap(tried);
    }
    take(chosen);
    total = least;
    distance.swap(best);
  }
  return centroids;
}

// Assigns every row to its nearest centroid; an empty cluster gets the row farthest from its own centroid.
void assign(const Rows& rows, KMeans& found) {
  std::vector<double> away(rows.count);
  std::fill(found.sizes.begin(), found.sizes.end(), 0);
  for (std::size_t row = 0; row < rows.count; ++row) {
    away[row] = std::numeric_limits<double>::max();
    for (std::size_t k = 0; k < found.sizes.size(); ++k) {
      const double distance = squared_distance(rows.at(row), &found.centroids[k * rows.columns], rows.columns);
      if (distance >= away[row]) continue;
      away[row] = distance;
      found.cluster[row] = static_cast<std::uint16_t>(k);
    }
    ++found.sizes[found.cluster[row]];
  }
  for (std::size_t k = 0; k < found.sizes.size(); ++k) {
    if (found.sizes[k] > 0) continue;
    std::size_t farthest = 0;
    double most = -1;
    for (std::size_t row = 0; row < rows.count; ++row) {
      if (found.sizes[found.cluster[row]] < 2 || away[row] <= most) continue;
      most = away[row];
      farthest = row;
    }
    --found.sizes[found.cluster[farthest]];
    found.cluster[farthest] = static_cast<std::uint16_t>(k);
    found.sizes[k] = 1;
    away[farthest] = 0;
  }
  found.inertia = std::accumulate(away.begin(), away.end(), 0.0);
}

// Moves centroids to the means of their rows; returns the sum of squared movements.
double move_centroids(const Rows& rows, KMeans& found) {
  std::vector<double> sums(found.centroids.size());
  for (std::size_t row = 0; row < rows.count; ++row) {
    double* sum = &sums[found.cluster[row] * rows.columns];
    for (std::size_t column = 0; column < rows.columns; ++column) sum[column] += rows.at(row)[column];
  }
  double moved = 0;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const double mean = sums[k] / static_cast<double>(found.sizes[k / rows.columns]);
    moved += (mean - found.centroids[k]) * (mean - found.centroids[k]);
    found.centroids[k] = mean;
  }
  return moved;
}

// Alternates assign() and move_centroids() until the squared movements sum to at most `least`, or for kMaxRounds.
void alternate(const Rows& rows, double least, KMeans& found) {
  while (found.rounds < kMaxRounds) {
    ++found.rounds;
    assign(rows, found);
    if (move_centroids(rows, found) <= least) break;
  }
  assign(rows, found);
}

KMeans one_start(const Rows& rows, const KMeansOptions& options, double variance, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  KMeans found{.centroids = start_centroids(rows, options.clusters, random)};
  found.cluster.resize(rows.count);
  found.sizes.resize(static_cast<std::size_t>(options.clusters));
  alternate(rows, kTolerance * variance, found);
  return found;
}

// Mean variance of the columns, the scale of kTolerance.
double mean_variance(const Rows& rows) {
  double sum = 0;
  for (std::size_t column = 0; column < rows.columns; ++column) {
    double mean = 0, square = 0;
    for (std::size_t row = 0; row < rows.count; ++row) mean += rows.at(row)[column];
    mean /= static_cast<double>(rows.count);
    for (std::size_t row = 0; row < rows.count; ++row) {
      const double away = rows.at(row)[column] - mean;
      square += away * away;
    }
    sum += square / static_cast<double>(rows.count);
  }
  return sum / static_cast<double>(rows.columns);
}

Result<void> check_options(std::size_t rows, const KMeansOptions& options) {
  if (rows == 0) return Error{"there is nothing to sort into clusters"};
  if (options.clusters < 1 || options.clusters > 65535) {
    return Error{"the number of clusters is " + std::to_string(options.clusters) + ", expected 1 to 65535"};
  }
  if (static_cast<std::size_t>(options.clusters) > rows) {
    return Error{"there are " + std::to_string(rows) + " rows for " + std::to_string(options.clusters) +
                 " clusters, expected at least as many rows: ask for fewer clusters"};
  }
  return {};
}

}  // namespace

Result<KMeans> k_means(std::span<const double> values, std::size_t columns, const KMeansOptions& options) {
  const Rows rows{values.data(), values.size() / columns, columns};
  if (auto ok = check_options(rows.count, options); !ok) return ok.error();
  const double variance = mean_variance(rows);
  std::vector<KMeans> found;
  for (int start = 0; start < kStarts; ++start) {
    const std::uint64_t seed = options.seed * 0x9E3779B97F4A7C15U + static_cast<std::uint64_t>(start);
    found.push_back(one_start(rows, options, variance, seed));
  }
  const auto less = [](const KMeans& a, const KMeans& b) { return a.inertia < b.inertia; };
  KMeans best = std::move(*std::min_element(found.begin(), found.end(), less));
  alternate(rows, 0, best);  // runs to convergence; worth its time for the best start only
  return best;
}

double silhouette(std::span<const double> values, std::size_t columns, const KMeans& found, std::size_t most) {
  const std::size_t count = values.size() / columns, clusters = found.sizes.size();
  if (clusters < 2 || count == 0) return 0;
  const std::size_t used = std::min(count, most);
  std::vector<std::size_t> chosen;
  for (std::size_t k = 0; k < used; ++k) chosen.push_back(k * count / used);
  double sum = 0;
  for (std::size_t i : chosen) {
    std::vector<double> away(clusters), members(clusters);
    for (std::size_t j : chosen) {
      if (i == j) continue;
      away[found.cluster[j]] += std::sqrt(squared_distance(&values[i * columns], &values[j * columns], columns));
      ++members[found.cluster[j]];
    }
    const std::size_t own = found.cluster[i];
    if (members[own] == 0) continue;
    double other = std::numeric_limits<double>::max();
    for (std::size_t k = 0; k < clusters; ++k) {
      if (k != own && members[k] > 0) other = std::min(other, away[k] / members[k]);
    }
    const double inside = away[own] / members[own];
    if (other == std::numeric_limits<double>::max() || std::max(other, inside) == 0) continue;
    sum += (other - inside) / std::max(other, inside);
  }
  return sum / static_cast<double>(used);
}

}  // namespace wisp
