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
const std::string kGoldenMarkov = WISP_SOURCE_DIR "/tests/model/golden/v1_switched_markov.wisp";

SwitchedArxModel& switched(Model& model) { return std::get<SwitchedArxModel>(model.dynamics); }

void expect_same(const Model& a, const Model& b) {
  EXPECT_EQ(*model_bytes(a), *model_bytes(b));
  const auto &x = std::get<SwitchedArxModel>(a.dynamics), &y = std::get<SwitchedArxModel>(b.dynamics);
  expect_same_frame(x, y);
  EXPECT_EQ(x.switching, y.switching);
  EXPECT_EQ(x.regions, y.regions);
  EXPECT_EQ(x.initial, y.initial);
  EXPECT_EQ(x.transitions, y.transitions);
  EXPECT_EQ(x.lyapunov, y.lyapunov);
  ASSERT_EQ(x.modes.size(), y.modes.size());
  for (std::size_t k = 0; k < x.modes.size(); ++k) {
    expect_same_coefficients(x.modes[k], y.modes[k]);
    EXPECT_EQ(x.modes[k].shock, y.modes[k].shock);
  }
}

// Found by hand: all modes contract in a norm that weighs the older sample less.
Model with_lyapunov() {
  Model model = sample_switched();
  switched(model).lyapunov = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0.25, 0, 0, 0, 0, 0.25}};
  return model;
}

TEST(SwitchedModel, WhatIsWrittenIsRead) {
  for (const Model& model : {sample_switched(), sample_switched(Switching::kMarkov), with_lyapunov()}) {
    const auto bytes = model_bytes(model);
    ASSERT_TRUE(bytes) << bytes.error().message;
    const auto read = parse_model(*bytes, "switched.wisp");
    ASSERT_TRUE(read) << read.error().message;
    expect_same(*read, model);
  }
}

// Written when switched models came into the format; they must load, and mean the same, for ever.
TEST(SwitchedModel, TheGoldenFilesStillMeanTheSame) {
  if (std::getenv("WISP_WRITE_GOLDEN")) {
    ASSERT_TRUE(write_model(kGolden, with_lyapunov()));
    ASSERT_TRUE(write_model(kGoldenMarkov, sample_switched(Switching::kMarkov)));
  }
  const auto regions = read_model(kGolden), markov = read_model(kGoldenMarkov);
  ASSERT_TRUE(regions) << regions.error().message;
  ASSERT_TRUE(markov) << markov.error().message;
  expect_same(*regions, with_lyapunov());
  expect_same(*markov, sample_switched(Switching::kMarkov));
}

TEST(SwitchedModel, EveryTruncationAndEveryBitFlipIsAnError) { expect_damage_noticed(*model_bytes(with_lyapunov())); }

TEST(SwitchedModel, WhatMakesNoSenseIsRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  struct Wrong {
    std::function<void(SwitchedArxModel&)> make;
    const char* said;
    Switching switching = Switching::kRegions;
  };
  const Wrong all[] = {
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
         m.regions.assign(15, 0.0);
       },
       "mode 1 is unstable in single precision: spectral radius 1.0"},
      {[](auto& m) { m.regions.pop_back(); }, "the matrix of regions has 20 values, expected 21"},
      {[&](auto& m) { m.regions[3] = nan; }, "the matrix of regions holds a number that is not finite"},
      {[](auto& m) {
         m.initial = {1, 0, 0};
       },
       "switches by regions and has probabilities"},
      {[](auto& m) { m.lyapunov = {{1}}; }, "block 0 of the Lyapunov function has 1 values, expected 16"},
      {[](auto& m) { m.lyapunov.resize(2); }, "has 2 blocks, expected 1"},
      {[](auto& m) {
         m.lyapunov = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
       },
       "block 0 of the Lyapunov function is none"},
      {[](auto& m) { m.initial[0] = 0.5; }, "the probability of the first mode adds up to 1.5", Switching::kMarkov},
      {[](auto& m) { m.transitions[1] = -0.1; }, "what follows mode 0 holds a probability below 0", Switching::kMarkov},
      {[](auto& m) { m.transitions.pop_back(); }, "the matrix of transitions has 8 values", Switching::kMarkov},
      {[](auto& m) { m.regions = {1}; }, "the matrix of regions has 1 values, expected 0", Switching::kMarkov},
  };
  for (const Wrong& wrong : all) {
    Model model = sample_switched(wrong.switching);
    wrong.make(switched(model));
    const auto bytes = model_bytes(model);
    ASSERT_FALSE(bytes) << wrong.said;
    EXPECT_THAT(bytes.error().message, HasSubstr(wrong.said));
  }
}

TEST(SwitchedModel, RegionsLookAtTheLagsThatAnyRowHas) {
  const Model model = sample_switched();
  const std::vector<RegionSample> expected{{false, 0, 1}, {false, 0, 2}, {false, 1, 1},
                                           {true, 0, 0},  {true, 0, 1},  {true, 0, 2}};
  EXPECT_EQ(region_samples(std::get<SwitchedArxModel>(model.dynamics).orders), expected);
}

TEST(SwitchedModel, OutputsThatDoNotFeedEachOtherAreBlocksOfTheirOwn) {
  Model model = sample_switched();
  EXPECT_EQ(state_blocks(switched(model)).size(), 1U);
  switched(model).orders.na(0, 1) = switched(model).orders.na(1, 0) = 0;
  for (ArxMode& mode : switched(model).modes) {
    mode.theta[0].erase(mode.theta[0].begin() + 2);
    mode.theta[1].erase(mode.theta[1].begin());
    mode.std_error.clear();
  }
  const auto blocks = state_blocks(switched(model));
  ASSERT_EQ(blocks.size(), 2U);
  EXPECT_EQ(blocks[0].states, 2);
  EXPECT_EQ(blocks[1].states, 1);
  EXPECT_EQ(blocks[0].companion[0], (std::vector<double>{0.5, -0.1f, 1, 0}));
}

TEST(SwitchedModel, BlocksOfUpTo256StatesHaveTheirMatrices) {
  for (int states : {256, 257}) {
    ArxModel arx;
    arx.orders = {OrderMatrix(1, 1, states), OrderMatrix(1, 0), OrderMatrix(1, 0)};
    arx.theta = {std::vector<double>(static_cast<std::size_t>(states), 0.0)};
    arx.constant = arx.output_mean = arx.noise.sd = {0};
    EXPECT_EQ(state_blocks(switched_of(arx))[0].companion.size(), states == 256 ? 1U : 0U);
  }
}

TEST(SwitchedModel, OfAnArxModelHasItsNoise) {
  const Model model = sample_model();
  const auto& arx = std::get<ArxModel>(model.dynamics);
  const ArxModel mode = mode_model(switched_of(arx), 0);
  const auto covariance = [](const ResidualNoise& noise, int i, int j) {
    double sum = i == j ? noise.sd[i] * noise.sd[i] : 0;
    for (int r = 0; r < noise.rank; ++r) sum += noise.mixing[i * noise.rank + r] * noise.mixing[j * noise.rank + r];
    return sum;
  };
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) EXPECT_NEAR(covariance(mode.noise, i, j), covariance(arx.noise, i, j), 1e-15);
  }
  EXPECT_TRUE(check(switched_of(arx)));
}

}  // namespace
}  // namespace wisp::switched_test
