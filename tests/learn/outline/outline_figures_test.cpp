#include "learn/outline/outline_figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "learn/outline/made_outline.hpp"
#include "learn/outline/outline_fit.hpp"

namespace wisp::outline_figures_test {
namespace {

TEST(OutlineFigures, FitIsTheShareOfTheDeviationThatIsExplained) {
  const std::vector<double> y{1, 2, 3, 4};
  EXPECT_DOUBLE_EQ(fit_percent(y, y), 100);
  EXPECT_DOUBLE_EQ(fit_percent(y, std::vector<double>{2.5, 2.5, 2.5, 2.5}), 0);
  // Errors of 1 in all four against deviations 1.5, 0.5, 0.5, 1.5.
  EXPECT_NEAR(fit_percent(y, std::vector<double>{2, 3, 4, 5}), 100 * (1 - 2 / std::sqrt(5.0)), 1e-12);
  EXPECT_DOUBLE_EQ(fit_percent(std::vector<double>{3, 3}, std::vector<double>{3, 4}), 0);
}

TEST(OutlineFigures, AModelThatIsRightHasGoodFits) {
  const std::vector recordings{made::outline_recording({.rows = 3000})};
  const auto fit = fit_outline(recordings, {.paper = 2, .holdout = 0.5});
  ASSERT_TRUE(fit);
  const OutlineFigures& figures = *fit->summary.held_out;
  ASSERT_EQ(figures.steps, (std::vector<int>{1, 5, 15, kFreeRun}));
  EXPECT_GT(figures.tip_fit_percent[0], 60);
  EXPECT_GT(figures.tip_fit_percent[0], figures.tip_fit_percent[1]);
  EXPECT_GT(figures.overlap[0], figures.overlap[2]);
  EXPECT_GT(figures.overlap[0], 0.9);
  EXPECT_LT(figures.j[0], figures.j[2]);
}

TEST(OutlineFigures, AFreeRunWithoutInputIsTheMeanShape) {
  const std::vector recordings{made::outline_recording({.rows = 3000})};
  const auto fit = fit_outline(recordings);
  EXPECT_NEAR(fit->summary.learned.tip_fit_percent.back(), 0, 2);
}

}  // namespace
}  // namespace wisp::outline_figures_test
