#include "base/verdict.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace wisp::verdict_test {
namespace {

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

TEST(Verdict, NamesTheFirstCriterionThatIsMissedWithItsNumbers) {
  const Criterion criteria[] = {{40, Bound::kAtLeast, 30, "too few rows"},
                                {12.345, Bound::kAtLeast, 20, "the fit is {figure} %, at least {limit}", 1, "fit"},
                                {9, Bound::kAtMost, 1, "never reached"}};
  std::string code;
  EXPECT_EQ(first_missed(criteria, &code), "the fit is 12.3 %, at least 20.0");
  EXPECT_EQ(code, "fit");
}

TEST(Verdict, ABoundItselfIsNotMissed) {
  const Criterion criteria[] = {{20, Bound::kAtLeast, 20, "low"}, {1, Bound::kAtMost, 1, "high"}};
  EXPECT_FALSE(first_missed(criteria));
}

TEST(Verdict, AFigureAboveItsLimitIsMissed) {
  const Criterion criteria[] = {{0.126, Bound::kAtMost, 0.05, "{figure} of at most {limit}, not {figure}", 2}};
  EXPECT_EQ(first_missed(criteria), "0.13 of at most 0.05, not 0.13");
}

TEST(Verdict, AFigureThatWasNotMeasuredAbstains) {
  const Criterion criteria[] = {{kNotMeasured, Bound::kAtLeast, 1, "low"}, {kNotMeasured, Bound::kAtMost, 1, "high"}};
  EXPECT_FALSE(first_missed(criteria));
}

}  // namespace
}  // namespace wisp::verdict_test
