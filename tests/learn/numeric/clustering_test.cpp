#include "learn/numeric/clustering.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace wisp::clustering_test {
namespace {

// Points around the corners of a cube.
std::vector<double> corners(std::size_t each, double spread) {
  std::mt19937_64 random(3);
  std::vector<double> rows;
  for (std::size_t k = 0; k < 8 * each; ++k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double noise = static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
      rows.push_back(static_cast<double>(k % 8 >> axis & 1) + spread * noise);
    }
  }
  return rows;
}

// Lloyd's rounds without any bound, from given centroids.
double plain_inertia(const std::vector<double>& rows, std::vector<double> centroids) {
  const std::size_t count = rows.size() / 3, clusters = centroids.size() / 3;
  double inertia = 0;
  for (int round = 0; round < 100; ++round) {
    std::vector<double> sums(centroids.size()), sizes(clusters);
    inertia = 0;
    for (std::size_t row = 0; row < count; ++row) {
      double least = std::numeric_limits<double>::max();
      std::size_t best = 0;
      for (std::size_t k = 0; k < clusters; ++k) {
        double distance = 0;
        for (std::size_t i = 0; i < 3; ++i) {
          distance += (rows[3 * row + i] - centroids[3 * k + i]) * (rows[3 * row + i] - centroids[3 * k + i]);
        }
        if (distance < least) {
          least = distance;
          best = k;
        }
      }
      inertia += least;
      ++sizes[best];
      for (std::size_t i = 0; i < 3; ++i) sums[3 * best + i] += rows[3 * row + i];
    }
    for (std::size_t k = 0; k < centroids.size(); ++k) centroids[k] = sums[k] / sizes[k / 3];
  }
  return inertia;
}

TEST(KMeans, FindsClustersThatAreThere) {
  const auto rows = corners(50, 0.3);
  const auto found = k_means(rows, 3, {.clusters = 8});
  ASSERT_TRUE(found);
  for (std::size_t size : found->sizes) EXPECT_EQ(size, 50U);
  for (std::size_t row = 8; row < 400; ++row) EXPECT_EQ(found->cluster[row], found->cluster[row % 8]);
  EXPECT_GT(silhouette(rows, 3, *found), 0.7);
}

TEST(KMeans, TheBestStartIsRunUntilNothingChangesSides) {
  // Clouds that run into each other, so that rows change sides for long.
  const auto rows = corners(200, 1.6);
  const auto found = k_means(rows, 3, {.clusters = 6});
  ASSERT_TRUE(found);
  EXPECT_NEAR(plain_inertia(rows, found->centroids), found->inertia, 1e-9 * found->inertia);
}

TEST(KMeans, NoClusterIsEmptyEvenWhereRowsCoincide) {
  std::vector<double> rows(30, 1.0);
  rows[0] = 2;
  const auto found = k_means(rows, 3, {.clusters = 4});
  ASSERT_TRUE(found);
  EXPECT_THAT(found->sizes, testing::Each(testing::Gt(0U)));
}

TEST(KMeans, TheSilhouetteOfClustersOnOnePointIsZero) {
  const std::vector<double> rows(30, 1.0);
  const auto found = k_means(rows, 3, {.clusters = 2});
  ASSERT_TRUE(found);
  EXPECT_EQ(silhouette(rows, 3, *found), 0);
}

TEST(KMeans, MoreClustersThanRowsIsAnError) {
  const std::vector<double> rows(6, 0.5);
  const auto found = k_means(rows, 3, {.clusters = 3});
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().message, testing::HasSubstr("2 rows for 3 clusters"));
  EXPECT_FALSE(k_means({}, 3, {.clusters = 1}));
  EXPECT_FALSE(k_means(rows, 3, {.clusters = 0}));
}

}  // namespace
}  // namespace wisp::clustering_test
