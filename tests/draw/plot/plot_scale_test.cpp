#include "draw/plot/plot_scale.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace wisp::drawing::plot_scale_test {
namespace {

using ::testing::ElementsAre;

TEST(PlotScale, TicksAreRoundNumbersInsideTheAxis) {
  const Ticks ticks = make_ticks({0.03, 1.07, 0, 300}, 5, false);
  EXPECT_THAT(ticks.labels, ElementsAre("0.2", "0.4", "0.6", "0.8", "1.0"));
  EXPECT_EQ(ticks.shared, "");
}

TEST(PlotScale, TicksMeetTheEndsThatAreRound) {
  const Ticks ticks = make_ticks({-1, 1, 0, 300}, 4, false);
  EXPECT_THAT(ticks.labels, ElementsAre("−1.0", "−0.5", "0.0", "0.5", "1.0"));
}

TEST(PlotScale, WholeNumbersStayWhole) {
  const Ticks ticks = make_ticks({-0.4, 3.4, 0, 300}, 9, true);
  EXPECT_THAT(ticks.labels, ElementsAre("0", "1", "2", "3"));
}

TEST(PlotScale, SmallAndLargeNumbersShareAPower) {
  const Ticks small = make_ticks({0, 4e-5, 0, 300}, 4, false);
  EXPECT_EQ(small.shared, "×10⁻⁵");
  EXPECT_THAT(small.labels, ElementsAre("0", "1", "2", "3", "4"));
  const Ticks large = make_ticks({0, 2.5e6, 0, 300}, 5, false);
  EXPECT_EQ(large.shared, "×10⁶");
  EXPECT_THAT(large.labels, ElementsAre("0.0", "0.5", "1.0", "1.5", "2.0", "2.5"));
}

TEST(PlotScale, AnAxisHasTwoTicksAtLeast) {
  for (const double high : {1.05, 1.9, 2.1, 4.9, 7.0, 9.7, 19.0}) {
    for (const double low : {-0.95, 0.05, 0.6}) {
      EXPECT_GE(make_ticks({low, high, 0, 100}, 2, false).at.size(), 2U) << low << " to " << high;
    }
  }
}

TEST(PlotScale, LogarithmicTicksArePowersOfTen) {
  const Ticks ticks = make_ticks({0.5, 2e4, 0, 300, true}, 8, false);
  EXPECT_THAT(ticks.labels, ElementsAre("10⁰", "10¹", "10²", "10³", "10⁴"));
  EXPECT_FALSE(ticks.between.empty());
}

TEST(PlotScale, AShortLogarithmicAxisAlsoHasTwosAndFives) {
  const Ticks ticks = make_ticks({0.9, 12, 0, 300, true}, 8, false);
  EXPECT_THAT(ticks.labels, ElementsAre("1", "2", "5", "10"));
}

TEST(PlotScale, PlacesAreLinearOrLogarithmic) {
  const Scale linear{10, 20, 0, 100};
  EXPECT_DOUBLE_EQ(linear(15), 50);
  const Scale logarithmic{1, 100, 0, 100, true};
  EXPECT_DOUBLE_EQ(logarithmic(10), 50);
  EXPECT_FALSE(logarithmic.shows(0));
  EXPECT_TRUE(linear.shows(0));
}

}  // namespace
}  // namespace wisp::drawing::plot_scale_test
