#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "wisp/record/recording.hpp"

namespace wisp::attribute_test {
namespace {

TEST(Attribute, NumbersRoundTripBitForBit) {
  Recording recording;
  const std::vector<double> values = {0, 1.0 / 3, -5e-324, 1e300};
  set_numbers_attribute(recording, "knots", values);
  set_numbers_attribute(recording, "knots", values);
  EXPECT_EQ(recording.attributes.size(), 1u);
  EXPECT_EQ(**numbers_attribute(recording, "knots"), values);
  EXPECT_FALSE(numbers_attribute(recording, "other")->has_value());
}

TEST(Attribute, WhatIsNotANumberIsNamed) {
  const Recording recording{.source = "a.csv", .attributes = {{"knots", "0 1 two 3"}}};
  const auto outcome = numbers_attribute(recording, "knots");
  ASSERT_FALSE(outcome);
  EXPECT_THAT(outcome.error().message, testing::AllOf(testing::HasSubstr("a.csv"), testing::HasSubstr("\"two\"")));
}

}  // namespace
}  // namespace wisp::attribute_test
