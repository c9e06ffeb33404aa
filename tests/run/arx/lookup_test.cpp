// Rows that no input drives: which of them an instance plays, and where it jumps.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/cost.hpp"

namespace wisp::lookup_test {
namespace {

constexpr int kRows = 300, kShortest = 12, kLongest = 36;  // 0.4 and 1.2 s at 30 rows a second

// A point that goes round in a circle, once in 60 rows of three in six, and twice as wide in the last tenth. Its third
// output is the number of the row: it hears nothing of itself, and what is read of it is the row that is played.
Model circling_model() {
  Model model;
  model.name = "circling";
  model.rate_hz = 30;
  ArxModel arx;
  arx.orders = {OrderMatrix(4, 4), OrderMatrix(4, 0), OrderMatrix(4, 0)};
  arx.theta.resize(4);
  arx.constant = arx.output_mean = {0, 0, 0, 0};
  arx.noise.sd = {1, 1, 1, 1};
  ResampledResiduals& resampled = arx.noise.resampled;
  resampled.scale = {1, 1, 1e-3, 1e-3};
  resampled.ends = {100, kRows};
  for (int row = 0; row < kRows; ++row) {
    const double turn = 2 * 3.14159265358979 * row / 60, wide = row < kRows * 9 / 10 ? 50 : 100;
    for (double value : {wide * std::cos(turn), wide * std::sin(turn), row % 100 * 1.0, row / 100 * 1.0}) {
      resampled.rows.push_back(static_cast<std::int8_t>(std::lround(value)));
    }
  }
  for (const char* name : {"x", "y"}) model.outputs.push_back({name, "", -130, 130});
  for (const char* name : {"row", "hundreds"}) model.outputs.push_back({name, "", -0.15, 0.15});
  model.dynamics = arx;
  return model;
}

struct Frame {
  float x, y;
  int row;
};

std::vector<Frame> played(const Model& model, int frames, std::uint64_t seed = 1) {
  auto bank = Bank::create(model, {.seed = seed});
  EXPECT_TRUE(bank) << bank.error().message;
  const InstanceId id = bank->spawn();
  std::vector<Frame> out;
  for (int frame = 0; frame < frames; ++frame) {
    bank->step();
    float values[4];
    bank->outputs(id, values);
    out.push_back({values[0], values[1], static_cast<int>(std::lround(1000 * values[2] + 100'000 * values[3]))});
  }
  return out;
}

TEST(Lookup, FollowsRowsForADrawnTimeAndNeverOverAnEnd) {
  const auto frames = played(circling_model(), 5000);
  std::map<int, int> lengths;
  int length = 1, over = 0;
  for (std::size_t k = 1; k < frames.size(); ++k) {
    const bool next = frames[k].row == frames[k - 1].row + 1;
    over += next && frames[k].row == 100 ? 1 : 0;
    if (!next) ++lengths[length];
    length = next ? length + 1 : 1;
  }
  EXPECT_EQ(over, 0);
  EXPECT_GE(lengths.begin()->first, kShortest);
  EXPECT_LE(lengths.rbegin()->first, kLongest);
  EXPECT_GT(lengths.size(), 20u);
}

TEST(Lookup, JumpsToWhereItGoesOnAsBefore) {
  const auto frames = played(circling_model(), 5000);
  int jumps = 0, near = 0;
  for (std::size_t k = 40; k < frames.size(); ++k) {
    if (frames[k].row == frames[k - 1].row + 1) continue;
    ++jumps;
    // Round the circle in one frame it goes by 5: from the other circle, or against the way, it would be far.
    near += std::hypot(frames[k].x - frames[k - 1].x, frames[k].y - frames[k - 1].y) < 30 ? 1 : 0;
  }
  EXPECT_GT(jumps, 150);
  EXPECT_GT(near, jumps * 8 / 10);
}

TEST(Lookup, PlaysAllOfTheRowsAboutEquallyOften) {
  const auto frames = played(circling_model(), 20000);
  std::vector<int> counts(10, 0);
  for (const Frame& frame : frames) ++counts[static_cast<std::size_t>(frame.row * 10 / kRows)];
  for (std::size_t k = 0; k < counts.size(); ++k) {
    EXPECT_GT(counts[k], 700) << k;  // of 2000: the last tenth is far from all others
    EXPECT_LT(counts[k], 4000) << k;
  }
}

TEST(Lookup, PlaysNothingThatItPlayedJustNow) {
  const auto frames = played(circling_model(), 5000);
  for (std::size_t k = 40; k < frames.size(); ++k) {
    if (frames[k].row == frames[k - 1].row + 1) continue;
    for (std::size_t back = 1; back <= 21; ++back) EXPECT_NE(frames[k].row, frames[k - back].row) << k;
  }
}

TEST(Lookup, AnotherSeedPlaysOtherRows) {
  const auto rows = [](std::uint64_t seed) {
    std::vector<int> out;
    for (const Frame& frame : played(circling_model(), 100, seed)) out.push_back(frame.row);
    return out;
  };
  EXPECT_EQ(rows(1), rows(1));
  EXPECT_NE(rows(1), rows(2));
}

// Rows of one each, and of one only, are played too.
TEST(Lookup, ShortStretchesArePlayed) {
  Model model = circling_model();
  ResampledResiduals& resampled = std::get<ArxModel>(model.dynamics).noise.resampled;
  resampled.rows.resize(12);
  for (const std::vector<std::uint32_t>& ends : {std::vector<std::uint32_t>{1, 2, 3}, {3}, {1, 3}}) {
    resampled.ends = ends;
    for (const Frame& frame : played(model, 200)) EXPECT_LT(frame.row, 3);
  }
}

TEST(Lookup, AnInstanceLivesTheSameLifeInABankOfAnySizeAndAfterARestore) {
  const Model model = still_flame_model();
  const auto lived = [&](int capacity, bool restored) {
    auto bank = Bank::create(model, {.capacity = capacity});
    EXPECT_TRUE(bank);
    for (int k = 1; k < capacity; ++k) bank->spawn();
    const InstanceId id = bank->spawn(77);
    std::vector<float> all;
    for (int frame = 0; frame < 200; ++frame) {
      bank->step();
      if (restored && frame % 7 == 5) {  // in the middle of searches too
        std::vector<std::byte> bytes(bank->save_bytes());
        bank->save(bytes);
        auto other = Bank::create(model, {.capacity = capacity});
        EXPECT_TRUE(other->restore(bytes));
        *bank = *std::move(other);
      }
      std::vector<float> values(bank->output_count());
      bank->outputs(id, values);
      all.insert(all.end(), values.begin(), values.end());
    }
    return all;
  };
  const auto alone = lived(1, false);
  EXPECT_EQ(lived(13, false), alone);
  EXPECT_EQ(lived(1, true), alone);
  EXPECT_EQ(lived(13, true), alone);
}

TEST(Lookup, TheSearchIsSpreadOverTheFramesOfABlock) {
  const Cost cost = *count_operations(still_flame_model(2000));
  EXPECT_LT(cost.noise_operations, 250);
  EXPECT_LT(cost.worst_operations - cost.operations_per_frame, 300);
}

}  // namespace
}  // namespace wisp::lookup_test
