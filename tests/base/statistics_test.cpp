#include "base/statistics.hpp"

#include <gtest/gtest.h>

namespace wisp::statistics_test {
namespace {

TEST(Statistics, QuantileIsTheSampleOfTheNearestRank) {
  const std::vector<double> values{5, 1, 4, 2, 3};
  EXPECT_EQ(quantile(values, 0), 1);
  EXPECT_EQ(quantile(values, 0.5), 3);
  EXPECT_EQ(quantile(values, 0.6), 3);
  EXPECT_EQ(quantile(values, 0.65), 4);
  EXPECT_EQ(quantile(values, 1), 5);
  EXPECT_EQ(quantile(std::vector<float>{}, 0.5), 0);
}

TEST(Statistics, MedianOfAnEvenNumberIsTheUpperMiddle) {
  EXPECT_EQ(median(std::vector<double>{4, 1, 3, 2}), 3);
  EXPECT_EQ(median(std::vector<float>{2, 1, 3}), 2);
  EXPECT_EQ(median(std::vector<double>{}), 0);
}

TEST(Statistics, DeviationIsDividedByTheNumberOfSamples) {
  const std::vector<double> values{1, 3, 1, 3};
  EXPECT_EQ(mean(values), 2);
  EXPECT_EQ(deviation(values), 1);
  EXPECT_EQ(mean({}), 0);
  EXPECT_EQ(deviation({}), 0);
}

}  // namespace
}  // namespace wisp::statistics_test
