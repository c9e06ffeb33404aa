#include "capture/vision/survey.hpp"

#include <gtest/gtest.h>

#include "capture/support/synthetic.hpp"

namespace wisp::threshold_test {
namespace {

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
