#include "capture/vision/survey.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "capture/support/synthetic.hpp"

namespace wisp::threshold_test {
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

}  // namespace
}  // namespace wisp::threshold_test
