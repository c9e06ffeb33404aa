// Residuals that are played again: which rows an instance plays, and when it jumps.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "run/flame_model.hpp"
#include "wisp/run/bank.hpp"
#include "wisp/run/cost.hpp"

namespace wisp::resampled_residuals_test {
namespace {

constexpr int kRows = 400;

// Three outputs that are nothing but their residuals: what is read is the row that is played. x and hundreds of a row
// are its number in 8 bits each, the y of all rows is 1; wind from the other side turns the number about and leaves y.
Model bare_model(InputShape shape = InputShape::kEvenOdd) {
  const int regressors = regressor_count(shape);
  Model model;
  model.name = "bare";
  model.rate_hz = 60;
  model.inputs = {{"wind", "", has_powers(shape) ? -2.0 : 0.0, 2.0, shape}};
  ArxModel arx;
  arx.orders = {OrderMatrix(3, 3), OrderMatrix(3, regressors), OrderMatrix(3, regressors)};
  arx.theta.resize(3);
  arx.constant = arx.output_mean = {0, 0, 0};
  arx.noise.sd = {1, 1, 1};
  arx.input_mean.assign(regressors, 0.0);
  ResampledResiduals& resampled = arx.noise.resampled;
  resampled = resampled_flame_residuals(3, kRows, has_powers(shape));
  resampled.scale = {1, 1, 1};
  for (int row = 0; row < kRows; ++row) {
    resampled.rows[3 * row] = static_cast<std::int8_t>((row + 1) % 100);
    resampled.rows[3 * row + 1] = 1;
    resampled.rows[3 * row + 2] = static_cast<std::int8_t>((row + 1) / 100);
  }
  if (has_powers(shape)) resampled.mirror = {-1, 2, -3};
  for (const char* name : {"x", "y", "hundreds"}) model.outputs.push_back({name, "", -500, 500});
  model.dynamics = arx;
  return model;
}

ResampledResiduals& resampled_of(Model& model) { return std::get<ArxModel>(model.dynamics).noise.resampled; }

// The swinging wind that the residuals were recorded in.
float swing(int frame) { return 0.1f * static_cast<float>(frame % 20 < 10 ? frame % 20 : 20 - frame % 20); }

// x of every step along a wind.
template <class Wind>
std::vector<int> rows_played(const Model& model, int frames, Wind wind, std::uint64_t seed = 1) {
  auto bank = Bank::create(model, {.seed = seed});
  EXPECT_TRUE(bank) << bank.error().message;
  const InstanceId id = bank->spawn();
  std::vector<int> rows;
  for (int frame = 0; frame < frames; ++frame) {
    const float now = wind(frame);
    bank->set_common_inputs({&now, 1});
    bank->step();
    float values[3];
    bank->outputs(id, values);
    EXPECT_EQ(values[1], 1.0f);
    rows.push_back(static_cast<int>(std::lround(values[0] + 100 * values[2])));
  }
  return rows;
}

TEST(ResampledResiduals, GoOnWhileTheWindIsAsItWasThen) {
  const auto rows = rows_played(bare_model(), 400, swing);
  int jumps = 0, longest = 0, since = 0;
  for (int frame = 30; frame < 400; ++frame) {
    const bool next = rows[frame] == rows[frame - 1] + 1;
    jumps += next ? 0 : 1;
    since = next ? since + 1 : 0;
    longest = std::max(longest, since);
    // Where it goes, the wind and its rise are as they were there.
    EXPECT_NEAR(swing(rows[frame] - 1), swing(frame), 0.15 + 1e-3) << frame;
  }
  EXPECT_LE(longest, 40);  // it jumps even so, lest it repeat what was recorded
  EXPECT_GE(longest, 30);
  EXPECT_LT(jumps, 30);
}

TEST(ResampledResiduals, JumpWhereTheWindWasAlikeWhenItIsNot) {
  const auto steady = [](int) { return 0.5f; };
  const auto rows = rows_played(bare_model(), 400, steady);
  std::set<int> seen;
  for (int frame = 1; frame < 400; ++frame) {
    seen.insert(rows[frame]);
    if (rows[frame] == rows[frame - 1] + 1) continue;
    EXPECT_NEAR(swing(rows[frame] - 1), 0.5, 0.21) << frame;  // it swung then: over four steps it was near 0.5
  }
  EXPECT_GT(seen.size(), 60u);  // by chance, not the same each time
}

TEST(ResampledResiduals, NeverCrossTheEndOfAStretch) {
  Model model = bare_model();
  ResampledResiduals& resampled = resampled_of(model);
  resampled.tolerance = 10;
  resampled.longest = 1000;
  const auto rows = rows_played(model, 20000, swing);
  int ends = 0, crossed = 0;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    ends += rows[k - 1] == kRows / 3 ? 1 : 0;
    crossed += rows[k - 1] == kRows / 3 && rows[k] == kRows / 3 + 1 ? 1 : 0;
  }
  EXPECT_GT(ends, 20);
  EXPECT_LT(crossed, ends / 5);  // by chance one in 64, the number of rows that are alike
}

TEST(ResampledResiduals, WindFromTheOtherSidePlaysMirrorImages) {
  const auto rows = rows_played(bare_model(), 300, [](int frame) { return -swing(frame); });
  for (int frame = 40; frame < 300; ++frame) {
    if (swing(frame) < 0.35f) continue;  // calm has no side
    EXPECT_LT(rows[frame], 0) << frame;
    EXPECT_NEAR(swing(-rows[frame] - 1), swing(frame), 0.15 + 1e-3) << frame;
  }
}

TEST(ResampledResiduals, AnotherSeedPlaysOtherRows) {
  const auto steady = [](int) { return 0.5f; };
  EXPECT_NE(rows_played(bare_model(), 100, steady, 1), rows_played(bare_model(), 100, steady, 2));
  EXPECT_EQ(rows_played(bare_model(), 100, steady, 1), rows_played(bare_model(), 100, steady, 1));
}

// The same wind now, after another: 0.5 on the way up is not 0.5 on the way down.
TEST(ResampledResiduals, JumpWhereTheInputsPastWasAlike) {
  Model model = bare_model();
  resampled_of(model).longest = 1;  // a jump every step
  const auto rows = rows_played(model, 600, swing);
  for (int frame = 40; frame < 600; ++frame) {
    const int row = rows[frame] - 1;
    EXPECT_NEAR(swing(row), swing(frame), 0.11) << frame;            // one step away at most: a leaf has a few phases
    EXPECT_NEAR(swing(row + 16), swing(frame + 16), 0.11) << frame;  // four steps ago, one swing later
  }
}

// In calm all rows of calm are alike: none of them is favoured, and none is heard again within a second.
TEST(ResampledResiduals, InAWindThatStaysEveryRowThatIsAlikeHasItsTurn) {
  Model model = bare_model();
  ResampledResiduals& resampled = resampled_of(model);
  std::fill(resampled.winds.begin(), resampled.winds.end(), std::int16_t{0});
  resampled.longest = 10;
  const auto rows = rows_played(model, 4000, [](int) { return 0.0f; });
  std::set<int> seen;
  for (std::size_t k = 1; k < rows.size(); ++k) {
    seen.insert(std::abs(rows[k]));
    if (std::abs(rows[k]) == std::abs(rows[k - 1]) + 1 || k < 30) continue;
    for (std::size_t back = 1; back <= 30; ++back) EXPECT_NE(std::abs(rows[k]), std::abs(rows[k - back])) << k;
  }
  EXPECT_GT(seen.size(), 350u);
}

TEST(ResampledResiduals, AreScaledByTheNoise) {
  auto bank = Bank::create(bare_model(), {});
  ASSERT_TRUE(bank);
  const InstanceId id = bank->spawn();
  float values[3];
  for (float noise : {0.5f, 0.0f}) {
    bank->set_noise(noise);
    bank->step();
    bank->outputs(id, values);
    EXPECT_EQ(values[1], noise);
  }
}

TEST(ResampledResiduals, AnInstanceLivesTheSameLifeInABankOfAnySizeAndAfterARestore) {
  const Model model = flame_model({.wind = InputShape::kEvenOdd, .resampled_rows = 300});
  const auto lived = [&](int capacity, bool restored) {
    auto bank = Bank::create(model, {.capacity = capacity});
    EXPECT_TRUE(bank);
    for (int k = 1; k < capacity; ++k) bank->spawn();
    const InstanceId id = bank->spawn(77);
    std::vector<float> all;
    for (int frame = 0; frame < 200; ++frame) {
      std::vector<float> winds(bank->slots());
      for (int k = 0; k < bank->slots(); ++k) winds[k] = k == static_cast<int>(id.slot) ? -swing(frame) : swing(k * 3);
      bank->set_inputs(winds);
      bank->step();
      if (restored && frame == 100) {
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

TEST(ResampledResiduals, CostAProductAndASumAnOutputAndNowAndThenAJump) {
  const Cost gaussian = *count_operations(flame_model({.wind = InputShape::kEvenOdd}));
  const Cost resampled = *count_operations(flame_model({.wind = InputShape::kEvenOdd, .resampled_rows = 600}));
  EXPECT_LT(resampled.noise_operations, 16 * 2 + 130);
  EXPECT_LT(resampled.random_operations, 50);  // in a wind that was never recorded it searches in every step
  EXPECT_EQ(resampled.dynamics_operations, gaussian.dynamics_operations);
}

// What was recorded in a wind from the other side is the mirror image of what was recorded in one from this side.
TEST(ResampledResiduals, ARecordingFromTheOtherSideIsPlayedMirrored) {
  const Model model = bare_model();
  Model other = model;
  ResampledResiduals& resampled = resampled_of(other);
  for (std::int16_t& wind : resampled.winds) wind = static_cast<std::int16_t>(-wind);
  for (int row = 0; row < kRows; ++row) {
    resampled.rows[3 * row] *= -1;
    resampled.rows[3 * row + 2] *= -1;
  }
  const auto gusts = [](int frame) { return frame / 100 % 2 == 0 ? swing(3 * frame / 2) : -swing(frame); };
  const std::vector<int> rows = rows_played(model, 1000, gusts);
  EXPECT_EQ(rows_played(other, 1000, gusts), rows);
  EXPECT_GT(*std::max_element(rows.begin(), rows.end()), 0);
  EXPECT_LT(*std::min_element(rows.begin(), rows.end()), 0);
}

}  // namespace
}  // namespace wisp::resampled_residuals_test
