#include "learn/fidelity/fidelity_marginal.hpp"

#include <gtest/gtest.h>

#include "learn/numeric/made_series.hpp"

namespace wisp::fidelity_marginal_test {
namespace {

TEST(FidelityMarginal, AShiftIsItsOwnDistance) { EXPECT_DOUBLE_EQ(wasserstein1({3, 1, 2}, {6, 5, 4}), 3); }

TEST(FidelityMarginal, SamplesOfDifferentSizeAreComparedByQuantiles) {
  // Half of {0, 1} stays, half of each quarter moves: quantiles 0 0 1 1 against 0 1 1 1.
  EXPECT_DOUBLE_EQ(wasserstein1({0, 1}, {0, 1, 1, 1}), 0.25);
}

TEST(FidelityMarginal, WassersteinAgreesWithNumpy) {
  auto y = made::second_series(130);
  EXPECT_NEAR(wasserstein1(made::first_series(), y), 0.08601030644615586, 1e-12);
}

TEST(FidelityMarginal, StandardDeviationDividesByN) {
  const double samples[] = {1, 3};
  EXPECT_DOUBLE_EQ(standard_deviation(samples), 1);
}

}  // namespace
}  // namespace wisp::fidelity_marginal_test
