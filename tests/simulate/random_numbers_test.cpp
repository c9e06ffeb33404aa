#include "simulate/random_numbers.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace wisp::flow::random_numbers_test {
namespace {

TEST(RandomNumbers, AreTheSameWordsForEver) {
  RandomNumbers numbers(1, 2);
  EXPECT_EQ(numbers.word(), 10401533845464923035U);
  EXPECT_EQ(random_word(1, 2, 1), numbers.word());
}

TEST(RandomNumbers, DifferBySeedStreamAndPlace) {
  EXPECT_NE(random_word(1, 0, 0), random_word(2, 0, 0));
  EXPECT_NE(random_word(1, 0, 0), random_word(1, 1, 0));
  EXPECT_NE(random_word(1, 0, 0), random_word(1, 0, 1));
}

// 100 000 numbers: the bounds are five standard errors, so one fixed seed fails by chance once in a million.
TEST(RandomNumbers, AreNearNormal) {
  RandomNumbers numbers(5, 0);
  constexpr int kCount = 100000;
  double sum = 0;
  double squares = 0;
  double fourths = 0;
  for (int k = 0; k < kCount; ++k) {
    const double x = numbers.normal();
    sum += x;
    squares += x * x;
    fourths += x * x * x * x;
  }
  EXPECT_NEAR(sum / kCount, 0, 5 / std::sqrt(kCount));
  EXPECT_NEAR(squares / kCount, 1, 5 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(fourths / kCount, 2.9, 5 * std::sqrt(90.0 / kCount));
}

TEST(RandomNumbers, AreEvenOverTheUnitInterval) {
  RandomNumbers numbers(6, 0);
  double sum = 0;
  for (int k = 0; k < 100000; ++k) {
    const double x = numbers.uniform();
    ASSERT_GE(x, 0);
    ASSERT_LT(x, 1);
    sum += x;
  }
  EXPECT_NEAR(sum / 100000, 0.5, 5 * std::sqrt(1.0 / 12 / 100000));
}

}  // namespace
}  // namespace wisp::flow::random_numbers_test
