#include "record/number_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

namespace wisp::number_text_test {
namespace {

TEST(NumberText, IsTheShortestThatReadsBack) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(-25), "-25");
  for (const double value : {1.0 / 3, 1e-300, -std::numeric_limits<double>::max(), 5e-324})
    EXPECT_EQ(std::strtod(number_text(value).c_str(), nullptr), value);
}

TEST(NumberText, HasAtMostTheDigitsThatWereAskedFor) {
  EXPECT_EQ(number_text(1.0 / 3, 2), "0.33");
  EXPECT_EQ(number_text(0.5, 4), "0.5");
  EXPECT_EQ(number_text(123456.7, 4), "1.235e+05");
  EXPECT_EQ(number_text(-std::numeric_limits<double>::max(), 17), "-1.7976931348623157e+308");
}

TEST(NumberText, SaysWhatIsNoNumber) {
  EXPECT_EQ(number_text(std::nan("")), "nan");
  EXPECT_EQ(number_text(-std::numeric_limits<double>::infinity(), 3), "-inf");
}

}  // namespace
}  // namespace wisp::number_text_test
