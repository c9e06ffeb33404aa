#include "sound/wind_math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace wisp::wind::wind_math_test {
namespace {

TEST(WindMath, Log2IsWithinItsStatedError) {
  for (int exponent = -126; exponent < 127; ++exponent) {
    for (int step = 0; step < 97; ++step) {
      const float x = std::ldexp(1 + static_cast<float>(step) / 97, exponent);
      const double exact = std::log2(static_cast<double>(x));
      const double rounding = std::abs(exact) * 0x1p-23;
      EXPECT_NEAR(log2_of(x), exact, 2e-7 + rounding) << x;
    }
  }
}

TEST(WindMath, Log2OfOneIsZero) { EXPECT_EQ(log2_of(1.0F), 0.0F); }

TEST(WindMath, Exp2IsWithinItsStatedError) {
  for (float x = -125; x <= 125; x += 0.0137F) {
    const double exact = std::exp2(static_cast<double>(x));
    EXPECT_NEAR(exp2_of(x), exact, 4e-7 * exact) << x;
  }
}

TEST(WindMath, Exp2HoldsWhatIsOutOfRange) {
  EXPECT_EQ(exp2_of(1e30F), std::ldexp(1.0F, 125));
  EXPECT_EQ(exp2_of(-1e30F), std::ldexp(1.0F, -125));
}

TEST(WindMath, DecibelsAndBack) {
  EXPECT_NEAR(decibels(1e-3F), -30, 1e-5);
  EXPECT_NEAR(decibels(0.0F), -120, 1e-4);
  for (float db = -110; db < 20; db += 3.7F) EXPECT_NEAR(decibels(from_decibels(db)), db, 2e-5);
}

TEST(WindMath, SigmoidRunsFromZeroToOne) {
  EXPECT_FLOAT_EQ(sigmoid(0.0F), 0.5F);
  EXPECT_NEAR(sigmoid(2.0F), 1 / (1 + std::exp(-2.0)), 1e-6);
  EXPECT_LT(sigmoid(-200.0F), 1e-30F);
  EXPECT_EQ(sigmoid(200.0F), 1.0F);
}

}  // namespace
}  // namespace wisp::wind::wind_math_test
