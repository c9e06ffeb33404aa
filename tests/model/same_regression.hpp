#pragma once
// Whether two regressions are the same, number by number.

#include <gtest/gtest.h>

namespace wisp {

/// What ARX models and the modes of switched ones have: coefficients, how sure they are, and constants.
template <class Regression>
void expect_same_coefficients(const Regression& a, const Regression& b) {
  EXPECT_EQ(a.theta, b.theta);
  EXPECT_EQ(a.std_error, b.std_error);
  EXPECT_EQ(a.constant, b.constant);
}

/// What ARX models and switched ones have: orders and operating point.
template <class Dynamics>
void expect_same_frame(const Dynamics& a, const Dynamics& b) {
  EXPECT_EQ(a.orders, b.orders);
  EXPECT_EQ(a.output_mean, b.output_mean);
  EXPECT_EQ(a.input_mean, b.input_mean);
}

}  // namespace wisp
