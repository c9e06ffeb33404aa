#include "learn/flame/blow_outs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "learn/flame/made_blow_outs.hpp"
#include "learn/outline/outline_fit.hpp"

namespace wisp::blow_outs_test {
namespace {

using testing::HasSubstr;

void blank(Recording& recording, std::size_t begin, std::size_t end) {
  for (Channel& channel : recording.channels) {
    if (channel.role == Role::kInput) continue;
    for (std::size_t row = begin; row < end; ++row) channel.samples[row] = std::numeric_limits<double>::quiet_NaN();
  }
}

std::vector<double>& wind_of(Recording& recording) {
  return recording.channels[*find_channel(recording, "wind")].samples;
}

TEST(BlowOuts, AreFoundWhereTheFlameWentOut) {
  const auto made = made::blow_out_recording({.shortest = 0.2});
  const auto found = find_blow_outs(made.recording, "wind");
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_GT(made.deaths.size(), 5U);
  ASSERT_EQ(found->size(), made.deaths.size());
  for (std::size_t k = 0; k < found->size(); ++k) {
    EXPECT_EQ((*found)[k].gone, made.deaths[k]);
    EXPECT_EQ((*found)[k].back, made.deaths[k] + 90);
    EXPECT_TRUE((*found)[k].blown);
    EXPECT_GT((*found)[k].wind, 1.2 * made::kWindUnit * 0.3);
  }
}

TEST(BlowOuts, AStretchWithoutWindBeforeItIsNotBlown) {
  auto made = made::blow_out_recording({.every = 0});
  auto& wind = wind_of(made.recording);
  std::fill(wind.begin() + 900, wind.begin() + 1010, 0.05);
  blank(made.recording, 1000, 1100);
  const auto found = find_blow_outs(made.recording, "wind");
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 1U);
  EXPECT_FALSE(found->front().blown);
}

// Frames that a camera lost while it blows are no evidence.
TEST(BlowOuts, LostRowsAreNone) {
  auto made = made::blow_out_recording({.every = 0});
  auto& wind = wind_of(made.recording);
  std::fill(wind.begin() + 900, wind.begin() + 1010, 1.0);
  blank(made.recording, 1000, 1100);
  ASSERT_EQ(find_blow_outs(made.recording, "wind")->size(), 1U);
  RowFlag lost{std::string(kLostRows), std::vector<std::uint8_t>(made.recording.rows())};
  std::fill(lost.rows.begin() + 1000, lost.rows.begin() + 1100, 1);
  made.recording.flags.push_back(lost);
  EXPECT_TRUE(find_blow_outs(made.recording, "wind")->empty());
  for (std::size_t row = 1000; row < 1100; row += 2) made.recording.flags.back().rows[row] = 0;
  EXPECT_EQ(find_blow_outs(made.recording, "wind")->size(), 1U);
}

TEST(BlowOuts, AFlameThatComesBackByItselfDidNotGoOut) {
  auto made = made::blow_out_recording({.every = 0});
  blank(made.recording, 1000, 1020);
  blank(made.recording, 0, 200);  // nobody saw it go
  const auto found = find_blow_outs(made.recording, "wind");
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->empty());
}

TEST(BlowOuts, AGlimpseOfTheEmberDoesNotEndThem) {
  auto made = made::blow_out_recording({.every = 0});
  blank(made.recording, 1000, 1040);
  blank(made.recording, 1043, 1100);
  const auto found = find_blow_outs(made.recording, "wind");
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 1U);
  EXPECT_EQ(found->front().gone, 1000U);
  EXPECT_EQ(found->front().back, 1100U);
}

TEST(BlowOuts, AnOutlineThatEveryThirdRowLacksDidNotGoOut) {
  auto made = made::blow_out_recording({.every = 0});
  auto& wind = wind_of(made.recording);
  std::fill(wind.begin() + 900, wind.begin() + 1010, 30.0);
  for (std::size_t row = 1000; row < 1100; row += 3) blank(made.recording, row, row + 1);
  EXPECT_TRUE(find_blow_outs(made.recording, "wind")->empty());
}

TEST(BlowOuts, AnEpisodeThatBeginsWithoutAFlameDoesNotBeginWithABlowOut) {
  auto made = made::blow_out_recording({.every = 0});
  auto& wind = wind_of(made.recording);
  std::fill(wind.begin() + 900, wind.begin() + 1010, 30.0);
  blank(made.recording, 1000, 1100);
  ASSERT_TRUE(find_blow_outs(made.recording, "wind")->front().blown);
  made.recording.episode_ids.assign(made.recording.rows(), 0);
  std::fill(made.recording.episode_ids.begin() + 1000, made.recording.episode_ids.end(), 1);
  EXPECT_FALSE(find_blow_outs(made.recording, "wind")->front().blown);
}

TEST(BlowOuts, ThatLastToTheEndOfTheRecordingAreFound) {
  auto made = made::blow_out_recording({.every = 0});
  auto& wind = wind_of(made.recording);
  std::fill(wind.begin() + 3480, wind.begin() + 3510, 4 * made::kWindUnit);
  blank(made.recording, 3500, 3600);
  const auto found = find_blow_outs(made.recording, "wind");
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 1U);
  EXPECT_TRUE(found->front().blown);
  EXPECT_EQ(found->front().back, 3600U);
}

TEST(BlowOuts, WithoutThemWhatIsLeftBurns) {
  const auto made = made::blow_out_recording({.shortest = 0.2});
  const auto found = *find_blow_outs(made.recording, "wind");
  const Recording burning = without_blow_outs(made.recording, found);
  const auto& wind = burning.channels[*find_channel(burning, "wind")].samples;
  const auto& tip = burning.channels[0].samples;
  for (const BlowOut& blow_out : found) {
    for (std::size_t row = blow_out.gone - 1; row < blow_out.back + 30; ++row) {
      ASSERT_TRUE(std::isnan(wind[row]) && std::isnan(tip[row])) << row;
    }
    EXPECT_FALSE(std::isnan(tip[blow_out.gone - 60]));
    EXPECT_FALSE(std::isnan(tip[blow_out.back + 30]));
  }
}

TEST(BlowOuts, AModelIsLearnedFromBothSidesOfThem) {
  const auto made = made::blow_out_recording({.weakest = 3, .shortest = 0.5});
  const auto found = *find_blow_outs(made.recording, "wind");
  const Recording burning = without_blow_outs(made.recording, found);
  const auto whole = fit_outline(std::span(&made.recording, 1)), fit = fit_outline(std::span(&burning, 1));
  ASSERT_TRUE(whole) << whole.error().message;
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_TRUE(fit->summary.usable.verdict) << fit->summary.usable.reason;
  // A wind of 1 is what the flame lived in; the puffs that killed it are none of its business.
  EXPECT_LT(fit->summary.inputs[0].scale, whole->summary.inputs[0].scale);
  const double rows = static_cast<double>(fit->summary.rows_learned + fit->summary.rows_held_out);
  EXPECT_GT(rows, 3600 - 2.6 * 60 * static_cast<double>(found.size()));
  EXPECT_GT(rows, 3600 / 4.0);
}

TEST(BlowOuts, WhatCannotBeLookedThroughIsRefused) {
  const auto made = made::blow_out_recording({.shortest = 0.2});
  EXPECT_THAT(find_blow_outs(made.recording, "rain").error().message,
              HasSubstr("has no input rain, which tells what blew the flame out"));
  Recording plain = made.recording;
  plain.channels.erase(plain.channels.begin());
  EXPECT_FALSE(find_blow_outs(plain, "wind"));
}

}  // namespace
}  // namespace wisp::blow_outs_test
