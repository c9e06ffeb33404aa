#include "wisp/model/input_curve.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "model/sample_model.hpp"
#include "wisp/model/file.hpp"

namespace wisp::input_curve_test {
namespace {

using testing::HasSubstr;

const InputCurve kCurve{{0, 0.5, 1.5}, {0, 0.125, 1.5}};

TEST(InputCurve, IsAStraightLineFromKnotToKnotAndTheInputBeyond) {
  EXPECT_EQ(value_at(kCurve, 0.25), 0.0625);
  EXPECT_EQ(value_at(kCurve, 0.5), 0.125);
  EXPECT_EQ(value_at(kCurve, 1), 0.8125);
  for (double beyond : {-2.0, 0.0, 1.5, 7.0}) EXPECT_EQ(value_at(kCurve, beyond), beyond);
  EXPECT_TRUE(std::isnan(value_at(kCurve, NAN)));
  EXPECT_EQ(value_at({}, 0.3), 0.3);
}

TEST(InputCurve, ASlopeOfAMillionIsTaken) {
  EXPECT_TRUE(check({{0, 1e-6, 1}, {0, 0.5, 1}}, 0, 1));
  EXPECT_FALSE(check({{0, 0.99e-6, 1}, {0, 0.5, 1}}, 0, 1));
}

TEST(InputCurve, AModelWithABadOneIsRefused) {
  const std::vector<std::pair<std::string, std::function<void(Input&)>>> broken = {
      {"has a curve that does not bend it", [](Input& i) { i.shape = InputShape::kSplitSign; }},
      {"is bent by a curve that it has not", [](Input& i) { i.curve = {}; }},
      {"1 knots and 1 values",
       [](Input& i) {
         i.curve = {{0}, {0}};
       }},
      {"17 knots", [](Input& i) { i.curve.at.resize(17), i.curve.value.resize(17); }},
      {"3 knots and 2 values", [](Input& i) { i.curve.value.pop_back(); }},
      {"knot 1 of an input's curve is not a finite number", [](Input& i) { i.curve.value[1] = NAN; }},
      {"knot 1 of an input's curve is not a finite number", [](Input& i) { i.curve.at[1] = INFINITY; }},
      {"knot 1 of an input's curve is at 0.0", [](Input& i) { i.curve.at[1] = 1e-9; }},
      {"knot 1 of an input's curve is at -1", [](Input& i) { i.curve.at[1] = -1; }},
      {"knot 1 of an input's curve is -0.5", [](Input& i) { i.curve.value[1] = -0.5; }},
      {"knot 2 of an input's curve is 1.5", [](Input& i) { i.curve.value[1] = 1.6; }},
      {"expected the knots there", [](Input& i) { i.curve.value[2] = 1.25; }},
      {"expected within the input's range",
       [](Input& i) {
         i.curve = {{0, 2}, {0, 2}};
       }},
      {"begins at 0.25",
       [](Input& i) {
         i.curve = {{0.25, 1.5}, {0.25, 1.5}};
       }},
  };
  for (const auto& [word, harm] : broken) {
    Model model = sample_model();
    model.inputs[0].shape = InputShape::kSplitSignCurve;
    model.inputs[0].curve = kCurve;
    ASSERT_TRUE(check(model));
    harm(model.inputs[0]);
    const auto outcome = check(model);
    ASSERT_FALSE(outcome) << word;
    EXPECT_THAT(outcome.error().message, HasSubstr(word));
    EXPECT_THAT(outcome.error().message, HasSubstr("input wind"));
  }
}

}  // namespace
}  // namespace wisp::input_curve_test
