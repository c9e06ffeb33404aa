#include "capture/vision/survey.hpp"

#include <gtest/gtest.h>

#include "capture/support/synthetic.hpp"

namespace wisp::threshold_test {
namespace {

TEST(Threshold, HistogramCountsEveryPixel) {
  support::Plane plane(40, 30, 5);
  plane.fill({0, 0, 20, 30}, 9);
  Histogram all{};
  add_to_histogram(all, plane.view());
  EXPECT_EQ(all[9], 600u);
  EXPECT_EQ(all[5], 600u);
}

}  // namespace
}  // namespace wisp::threshold_test
