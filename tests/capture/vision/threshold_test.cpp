#include "wisp/capture/vision/threshold.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "capture/support/synthetic.hpp"

namespace wisp {
namespace {

TEST(Threshold, LiesBetweenTwoClusters) {
  Histogram histogram{};
  for (int v = 10; v <= 30; ++v) histogram[v] = 900;
  for (int v = 200; v <= 240; ++v) histogram[v] = 50;
  const TwoClusters clusters = split_histogram(histogram);
  EXPECT_GE(clusters.threshold, 30);
  EXPECT_LT(clusters.threshold, 200);
  EXPECT_DOUBLE_EQ(clusters.dark_mean, 20);
  EXPECT_DOUBLE_EQ(clusters.bright_mean, 220);
  EXPECT_NEAR(clusters.bright_share, 50 * 41 / (50 * 41 + 900.0 * 21), 1e-12);
}

TEST(Threshold, SeparationIsTheShareOfVarianceBetweenTheClusters) {
  Histogram two_values{};
  two_values[10] = two_values[200] = 5;
  EXPECT_NEAR(split_histogram(two_values).separation, 1, 1e-12);
  Histogram flat{};
  flat.fill(1);
  EXPECT_NEAR(split_histogram(flat).separation, 0.75, 1e-3);  // of a uniform distribution, by integration
}

TEST(Threshold, OneBrightnessHasNoSeparation) {
  Histogram histogram{};
  histogram[77] = 100;
  EXPECT_EQ(split_histogram(histogram).separation, 0);
  EXPECT_EQ(split_histogram(Histogram{}).separation, 0);
}

TEST(Threshold, HistogramCountsEveryStepthPixel) {
  support::Plane plane(40, 30, 5);
  plane.fill({0, 0, 20, 30}, 9);
  Histogram all{}, some{};
  add_to_histogram(all, plane.view(), 1);
  add_to_histogram(some, plane.view(), 4);
  EXPECT_EQ(all[9], 600u);
  EXPECT_EQ(all[5], 600u);
  EXPECT_EQ(some[5] + some[9], 10u * 7u);
}

// A ground of 20, a thing of 220, and a glow that gets fewer and fewer pixels towards the thing.
Histogram glowing() {
  Histogram histogram{};
  histogram[20] = 100000;
  for (int v = 40; v < 130; ++v) histogram[v] = static_cast<std::uint64_t>(130 - v) * 4;
  for (int v = 130; v < 200; ++v) histogram[v] = 10;
  histogram[220] = 20000;
  return histogram;
}

TEST(Threshold, MovesOutOfAGlowToWhereTheRimIsSteep) {
  const Histogram histogram = glowing();
  const TwoClusters clusters = split_histogram(histogram);
  ASSERT_LT(clusters.threshold, 130);
  const int level = steepest_level(histogram, clusters);
  EXPECT_GT(level, 125);
  EXPECT_LE(level, clusters.threshold + 0.4 * (clusters.bright_mean - clusters.threshold));
}

// Towards brighter levels the thing loses at every level the same share of what is left: no rim is steeper than
// another.
TEST(Threshold, StaysWhereTheRimIsAsSteepAsAnywhere) {
  Histogram histogram{};
  histogram[20] = 100000;
  for (int v = 40; v < 256; ++v) histogram[v] = static_cast<std::uint64_t>(1e5 * std::exp(-v / 30.0));
  const TwoClusters clusters = split_histogram(histogram);
  EXPECT_NEAR(steepest_level(histogram, clusters), clusters.threshold, 2);
}

}  // namespace
}  // namespace wisp
