#include "learn/numeric/chi_squared.hpp"

#include <gtest/gtest.h>

namespace wisp::chi_squared_test {
namespace {

// Values of R's pchisq and qchisq.
TEST(ChiSquared, TailAgreesWithTables) {
  EXPECT_NEAR(chi_squared_tail(3.841458820694124, 1), 0.05, 1e-12);
  EXPECT_NEAR(chi_squared_tail(18.307038053275146, 10), 0.05, 1e-12);
  EXPECT_NEAR(chi_squared_tail(2.0, 2), 0.36787944117144233, 1e-13);
  EXPECT_NEAR(chi_squared_tail(0, 5), 1, 0);
}

TEST(ChiSquared, QuantileIsTheInverseOfTheTail) {
  for (double freedom : {0.5, 1.0, 7.0, 300.0, 1e5}) {
    for (double p : {1e-6, 0.025, 0.5, 0.975, 0.999999}) {
      EXPECT_NEAR(1 - chi_squared_tail(chi_squared_quantile(p, freedom), freedom), p, 1e-9) << freedom << ' ' << p;
    }
  }
  EXPECT_NEAR(chi_squared_quantile(0.95, 1), 3.841458820694124, 1e-10);
}

}  // namespace
}  // namespace wisp::chi_squared_test
