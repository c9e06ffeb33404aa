// An instance alone is made with its outputs side by side: as it would be in a block, to the bit.

#include "run/arx/output_lanes.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "run/arx/arx_program.hpp"
#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"

namespace wisp::output_lanes_test {
namespace {

ArxModel& arx_of(Model& model) { return std::get<ArxModel>(model.dynamics); }

OutputProgram program_of(const Model& model, std::vector<std::byte>& memory) {
  const Regression regression = regression_of(model, std::get<ArxModel>(model.dynamics));
  Arena measured;
  make_output_program(regression, measured);
  memory.resize(measured.bytes());
  Arena arena(memory);
  return make_output_program(regression, arena);
}

std::size_t groups_of(const Model& model) {
  std::vector<std::byte> memory;
  return program_of(model, memory).groups;
}

// Outputs of other points than its own for one output, so that it goes with no other.
Model with_one_of_its_own() {
  Model model = flame_model({.points = 9, .wind = InputShape::kEvenOdd, .noise_rank = 1});
  ArxModel& arx = arx_of(model);
  arx.orders.na(4, 0) = 1;
  arx.theta[4].insert(arx.theta[4].begin(), 0.02);
  return model;
}

// All points look back at output 0, which looks back at itself alone: its group of one and theirs have a column in
// common.
Model with_one_that_leads() {
  Model model = flame_model({.points = 5, .wind = InputShape::kEvenOdd, .noise_rank = 1});
  ArxModel& arx = arx_of(model);
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) arx.orders.na(i, j) = j == i || j == 0 ? 2 : 0;
    const std::vector<double> winds(arx.theta[i].begin() + 8, arx.theta[i].end());
    arx.theta[i] = {-0.9, 0.2};
    if (i > 0) arx.theta[i].insert(arx.theta[i].begin(), {0.05, -0.02});
    arx.theta[i].insert(arx.theta[i].end(), winds.begin(), winds.end());
  }
  return model;
}

Model with_shocks_that_some_lack() {
  Model model = flame_model({.points = 8, .wind = InputShape::kEvenOdd, .noise_rank = 2});
  ArxModel& arx = arx_of(model);
  for (int i : {0, 5, 9}) arx.noise.sd[i] = 0;
  for (int i : {3, 5, 12}) arx.noise.mixing[2 * i] = 0;
  for (int i = 0; i < 16; ++i) arx.constant[i] = 0.001 * i - 0.004;
  return model;
}

// Who looks back at whom, how far, and whose shocks are none, by chance; coefficients so small that all are stable.
Model of_chance(unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); };
  Model model = flame_model({.points = 4 + below(6), .wind = InputShape::kEvenOdd, .noise_rank = below(3)});
  ArxModel& arx = arx_of(model);
  const int outputs = static_cast<int>(model.outputs.size()), kinds = 1 + below(3), leaders = below(3);
  for (int i = 0; i < outputs; ++i) {
    const int kind = below(kinds);
    arx.theta[i].clear();
    const auto add = [&] { arx.theta[i].push_back(0.001 * (below(80) - 40)); };
    for (int j = 0; j < outputs; ++j) {
      arx.orders.na(i, j) = j == i || j < leaders || j == (i ^ 1) ? kind : 0;
      for (int lag = 0; lag < arx.orders.na(i, j); ++lag) add();
    }
    for (int k = 0; k < arx.orders.inputs(); ++k) {
      arx.orders.nb(i, k) = 1 + kind;
      arx.orders.nk(i, k) = kind % 2;
      for (int lag = 0; lag <= kind; ++lag) add();
    }
    if (below(4) == 0) arx.noise.sd[i] = 0;
  }
  return model;
}

const struct {
  const char* name;
  Model model;
} kModels[] = {{"as many points as places", flame_model({.wind = InputShape::kEvenOdd})},
               {"fewer", flame_model({.points = 5, .wind = InputShape::kEvenOdd, .noise_rank = 1})},
               {"more", flame_model({.points = 13, .noise_rank = 2})},
               {"one output goes with no other", with_one_of_its_own()},
               {"all look back at one", with_one_that_leads()},
               {"some shocks are none", with_shocks_that_some_lack()},
               {"residuals", flame_model({.wind = InputShape::kEvenOdd, .resampled_rows = 300})},
               {"an end that mirrors the other", default_flame_model()},
               {"every output looks back at all", coupled_flame_model()}};

// Outputs of an instance of stream 5 over some hundred frames, in a bank whose company `change` changes before each.
template <class Change>
std::vector<float> life(const Model& model, int capacity, int instances, Change change) {
  auto bank = Bank::create(model, {.capacity = capacity, .seed = 3});
  EXPECT_TRUE(bank) << bank.error().message;
  const InstanceId watched = bank->spawn(5);
  for (int k = 1; k < instances; ++k) bank->spawn(100 + static_cast<std::uint64_t>(k));
  std::vector<float> all, row(bank->output_count());
  for (int frame = 0; frame < 240; ++frame) {
    change(*bank, frame);
    const float wind = static_cast<float>(frame * 11 % 100) / 40.0f - 1.25f;
    bank->set_inputs(watched, {&wind, 1});
    bank->advance(std::chrono::nanoseconds(21'000'000));
    EXPECT_TRUE(bank->outputs(watched, row));
    all.insert(all.end(), row.begin(), row.end());
  }
  return all;
}

const auto kAlone = [](Bank&, int) {};

TEST(OutputLanes, AnInstanceAloneLivesAsInABlock) {
  for (const auto& [name, model] : kModels) {
    const std::vector<float> in_a_block = life(model, 8, 8, kAlone);
    for (int instances : {1, 2, 3}) EXPECT_EQ(life(model, 8, instances, kAlone), in_a_block) << name << instances;
  }
}

TEST(OutputLanes, WhateverLooksBackAtWhatever) {
  int side_by_side = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const Model model = of_chance(seed);
    side_by_side += groups_of(model) > 0 ? 1 : 0;
    EXPECT_EQ(life(model, 8, 1, kAlone), life(model, 8, 8, kAlone)) << seed;
  }
  EXPECT_GT(side_by_side, 30);
}

TEST(OutputLanes, AnInstanceLivesTheSameWhoeverComesAndGoes) {
  const auto company = [](Bank& bank, int frame) {
    if (frame % 50 == 10) {
      for (std::uint64_t k = 0; k < 12; ++k) bank.spawn(200 + k);
    }
    if (frame % 50 == 30) {
      while (bank.size() > 1) bank.end(bank.at(bank.slots() - 1));
    }
    if (frame % 50 == 45) bank.spawn(300);
  };
  for (const auto& [name, model] : kModels) {
    EXPECT_EQ(life(model, 20, 1, company), life(model, 8, 8, kAlone)) << name;
  }
}

TEST(OutputLanes, AnInstanceThatWasRestoredGoesOn) {
  const auto restored = [](Bank& bank, int frame) {
    if (frame % 40 != 20) return;
    std::vector<std::byte> bytes(bank.save_bytes());
    bank.save(bytes);
    for (int k = 0; k < 7; ++k) bank.step();
    ASSERT_TRUE(bank.restore(bytes));
  };
  for (const auto& [name, model] : kModels) {
    EXPECT_EQ(life(model, 2, 1, restored), life(model, 2, 1, kAlone)) << name;
  }
}

TEST(OutputLanes, WithoutNoiseAnInstanceAloneLivesAsInABlock) {
  const auto silent = [](Bank& bank, int frame) { bank.set_noise(frame % 60 < 30 ? 0.0f : 2.0f); };
  for (const auto& [name, model] : kModels) {
    EXPECT_EQ(life(model, 8, 1, silent), life(model, 8, 8, silent)) << name;
  }
}

TEST(OutputLanes, ClampedStepsAreCountedAsInABlock) {
  Model model = with_shocks_that_some_lack();
  for (Output& output : model.outputs) output.highest = output.lowest + 0.45;
  const auto clamped = [&](int instances) {
    auto bank = Bank::create(model, {.capacity = 8});
    for (int k = 0; k < instances; ++k) bank->spawn(5);  // twins
    bank->set_noise(3);
    for (int k = 0; k < 300; ++k) bank->step();
    return bank->clamped().clamped / static_cast<std::uint64_t>(instances);
  };
  EXPECT_GT(clamped(8), 10U);
  EXPECT_LT(clamped(8), 290U);
  EXPECT_EQ(clamped(1), clamped(8));
}

// Eight outputs that look back in so many ways, up to eight.
Model flame_of_kinds(int kinds) {
  Model model = flame_model({.points = 4});
  for (int i = 0; i < 8; ++i) {
    const int kind = i % kinds, inputs = kind % 4, own = kind / 4;
    arx_of(model).orders.nb(i, 0) -= inputs;
    arx_of(model).orders.na(i, i) -= own;
    arx_of(model).theta[i].resize(arx_of(model).theta[i].size() - inputs - own);
  }
  return model;
}

TEST(OutputLanes, OutputsThatLookBackAlikeGoTogether) {
  EXPECT_EQ(groups_of(kModels[0].model), 2U);
  EXPECT_EQ(groups_of(with_one_of_its_own()), 4U);  // nine of x, less one, are a group, nine of y two
  EXPECT_EQ(groups_of(coupled_flame_model()), 2U);
  EXPECT_EQ(groups_of(flame_of_kinds(4)), 4U);
  EXPECT_EQ(groups_of(flame_of_kinds(5)), 0U) << "five sums for eight outputs: a block is as good";
}

TEST(OutputLanes, ColumnsOfWhatAGroupMakesComeFromIt) {
  std::vector<std::byte> memory;
  const OutputProgram flame = program_of(kModels[0].model, memory);
  ASSERT_EQ(flame.columns, 8U) << "x and y of eight points, and three powers of the wind for each";
  const auto count = [&](ColumnSource source) { return std::count(flame.source.begin(), flame.source.end(), source); };
  EXPECT_EQ(count(ColumnSource::kGroup), 2);
  EXPECT_EQ(count(ColumnSource::kOneRegressor), 6);
}

TEST(OutputLanes, NumbersOfAllChannelsAreDrawnToPlacesOfTheirOwn) {
  std::vector<bool> taken(64);
  for (std::uint32_t channel = 0; channel < 64; ++channel) {
    ASSERT_LT(normal_place(channel), 64U);
    EXPECT_FALSE(taken[normal_place(channel)]) << channel;
    taken[normal_place(channel)] = true;
  }
}

}  // namespace
}  // namespace wisp::output_lanes_test
