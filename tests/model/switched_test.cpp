#include "wisp/model/switched.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <limits>

#include "model/damaged_bytes.hpp"
#include "model/same_regression.hpp"
#include "model/sample_model.hpp"
#include "model/sample_switched.hpp"
#include "paths.hpp"
#include "wisp/model/file.hpp"

namespace wisp::switched_test {
namespace {

using testing::HasSubstr;

const std::string kGolden = WISP_SOURCE_DIR "/tests/model/golden/v1_switched.wisp";

SwitchedArxModel& switched(Model& model) { return std::get<SwitchedArxModel>(model.dynamics); }

void expect_same(const Model& a, const Model& b) {
  EXPECT_EQ(*model_bytes(a), *model_bytes(b));
  const auto &x = std::get<SwitchedArxModel>(a.dynamics), &y = std::get<SwitchedArxModel>(b.dynamics);
  expect_same_frame(x, y);
  EXPECT_EQ(x.initial, y.initial);
  EXPECT_EQ(x.transitions, y.transitions);
  EXPECT_EQ(x.shock_quantiles, y.shock_quantiles);
  ASSERT_EQ(x.modes.size(), y.modes.size());
  for (std::size_t k = 0; k < x.modes.size(); ++k) {
    expect_same_coefficients(x.modes[k], y.modes[k]);
    EXPECT_EQ(x.modes[k].shock, y.modes[k].shock);
  }
}

TEST(SwitchedModel, WhatIsWrittenIsRead) {
  const Model model = sample_switched();
  const auto bytes = model_bytes(model);
  ASSERT_TRUE(bytes) << bytes.error().message;
  const auto read = parse_model(*bytes, "switched.wisp");
  ASSERT_TRUE(read) << read.error().message;
  expect_same(*read, model);

  Model flaring = model;
  for (int k = 0; k < 17; ++k) switched(flaring).shock_quantiles.push_back(k < 16 ? 0.1 * k - 1 : 9);
  const auto again = parse_model(*model_bytes(flaring), "flaring.wisp");
  ASSERT_TRUE(again) << again.error().message;
  expect_same(*again, flaring);
}

// Written when switched models came into the format; it must load, and mean the same, for ever.
TEST(SwitchedModel, TheGoldenFileStillMeansTheSame) {
  if (std::getenv("WISP_WRITE_GOLDEN")) {
    ASSERT_TRUE(write_model(kGolden, sample_switched()));
  }
  const auto read = read_model(kGolden);
  ASSERT_TRUE(read) << read.error().message;
  expect_same(*read, sample_switched());
}

TEST(SwitchedModel, EveryTruncationAndEveryBitFlipIsAnError) { expect_damage_noticed(*model_bytes(sample_switched())); }

TEST(SwitchedModel, WhatMakesNoSenseIsRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Wrong {
    std::function<void(SwitchedArxModel&)> make;
    const char* said;
  };
  const Wrong all[] = {
      {[](auto& m) {
         m.shock_quantiles = {1, 2};
       },
       "quantiles has 2 values, expected 17"},
      {[](auto& m) {
         m.shock_quantiles = std::vector<double>(17, 1);
         m.shock_quantiles[3] = 0;
       },
       "quantiles do not ascend"},
      {[](auto& m) { m.modes.clear(); }, "0 modes, expected 1 to 64"},
      {[](auto& m) { m.modes.resize(65); }, "65 modes"},
      {[](auto& m) { m.modes[1].theta[1].pop_back(); },
       "mode 1: row 1 of the ARX coefficients has 3 values, expected 4"},
      {[&](auto& m) { m.modes[2].constant[0] = nan; }, "mode 2: the constant term"},
      {[](auto& m) { m.modes[0].shock[1] = 0.1; }, "mode 0: the matrix of shocks is not lower triangular"},
      {[](auto& m) { m.modes[0].shock.pop_back(); }, "mode 0: the size of shocks has 3 values, expected 4"},
      {[](auto& m) { m.modes[1].theta[0][0] = -1.2; }, "mode 1 is unstable in single precision"},
      {[](auto& m) {
         m.orders.na = OrderMatrix(2, 2);
         m.orders.na(0, 0) = 1;
         for (ArxMode& mode : m.modes) {
           mode.theta = {{-0.5, 0, 0}, {0, 0}};
           mode.std_error.clear();
         }
         m.modes[1].theta[0][0] = -1;  // a radius of 1 to the last bit
       },
       "mode 1 is unstable in single precision: spectral radius 1.0"},
      {[](auto& m) { m.initial[0] = 0.5; }, "the probability of the first mode adds up to 1.5"},
      {[](auto& m) { m.transitions[1] = -0.1; }, "what follows mode 0 holds a probability below 0"},
      {[](auto& m) { m.transitions.pop_back(); }, "the matrix of transitions has 8 values"},
  };
  for (const Wrong& wrong : all) {
    Model model = sample_switched();
    wrong.make(switched(model));
    const auto bytes = model_bytes(model);
    ASSERT_FALSE(bytes) << wrong.said;
    EXPECT_THAT(bytes.error().message, HasSubstr(wrong.said));
  }
}

}  // namespace
}  // namespace wisp::switched_test
