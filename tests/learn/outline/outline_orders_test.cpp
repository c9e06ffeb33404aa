// Orders and delays that are searched instead of given.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "learn/outline/made_outline.hpp"
#include "learn/outline/outline_fit.hpp"

namespace wisp::outline_orders_test {
namespace {

using testing::HasSubstr;

constexpr made::OutlineRecipe kWindy{.rows = 1500, .shock = 0.003, .wind = true};

OutlineSummary learned(const Recording& recording, const OutlineRecipe& options) {
  auto fit = fit_outline(std::vector{recording}, options);
  EXPECT_TRUE(fit) << (fit ? "" : fit.error().message);
  return fit ? fit->summary : OutlineSummary{};
}

// The wind is told so many frames before it acts.
Recording heard_early(Recording recording, std::size_t frames) {
  auto& wind = recording.channels[*find_channel(recording, "wind")].samples;
  wind.erase(wind.begin(), wind.begin() + static_cast<std::ptrdiff_t>(frames));
  wind.resize(recording.channels.front().samples.size(), 0.0);
  return recording;
}

TEST(OutlineOrders, GivenOnesAreTakenAsTheyAre) {
  const OutlineSummary summary = learned(made::outline_recording(kWindy), {.order = 3, .delay = 2});
  EXPECT_EQ(summary.choice.by, OutlineCriterion::kGiven);
  EXPECT_EQ(summary.choice.taken().order, 3);
  EXPECT_EQ(summary.choice.taken().delay, 2);
  EXPECT_EQ(summary.orders.na(0, 0), 3);
  EXPECT_EQ(summary.orders.nk(0, 0), 2);
  EXPECT_EQ(summary.choice.reason, "as given");
}

// The made outline has two lags of output and acts in the frame of its wind: more lags gain nothing.
TEST(OutlineOrders, ALowOrderIsFoundToDo) {
  const OutlineSummary summary = learned(made::outline_recording(kWindy), {.order = {}});
  EXPECT_EQ(summary.choice.by, OutlineCriterion::kHeldOutFreeRun);
  EXPECT_GE(summary.choice.taken().order, 2);
  EXPECT_LE(summary.choice.taken().order, 4);
  EXPECT_EQ(summary.orders.na(0, 0), summary.choice.taken().order);
  EXPECT_GE(summary.choice.candidates.size(), 10u);
  EXPECT_THAT(summary.choice.reason, HasSubstr("held-out"));
}

TEST(OutlineOrders, TheDelayOfTheWindIsFound) {
  const Recording early = heard_early(made::outline_recording(kWindy), 7);
  const OutlineSummary summary = learned(early, {.order = 4, .delay = {}});
  EXPECT_EQ(summary.choice.taken().order, 4);
  EXPECT_NEAR(summary.choice.taken().delay, 7, 1);
  EXPECT_EQ(summary.orders.nk(0, 0), summary.choice.taken().delay);
  const double searched = summary.held_out->tip_fit_percent.back();
  EXPECT_GT(searched, learned(early, {}).held_out->tip_fit_percent.back() + 3);
}

TEST(OutlineOrders, BothAreFoundTogether) {
  const Recording early = heard_early(made::outline_recording(kWindy), 4);
  const OutlineSummary summary = learned(early, {.order = {}, .delay = {}, .light = true});
  EXPECT_LE(summary.choice.taken().order, 6);
  EXPECT_NEAR(summary.choice.taken().delay, 4, 2);
}

// Where all coordinates hear each other their equations have twice as many lags of the wind, and two resonances that
// follow it: delays up to the wind's own and somewhat more are alike (held-out errors within 0.5 %), later ones are
// not.
TEST(OutlineOrders, AWholeOutlineIsFollowedAsWellAsWithTheDelayThatIsTrue) {
  const Recording early = heard_early(made::outline_recording(kWindy), 4);
  const OutlineSummary searched = learned(early, {.order = {}, .delay = {}});
  const OutlineSummary given = learned(early, {.order = 2, .delay = 4});
  EXPECT_LE(searched.choice.taken().order, 4);
  EXPECT_LE(searched.choice.taken().delay, 6);
  EXPECT_GT(searched.held_out->tip_fit_percent.back(), given.held_out->tip_fit_percent.back() - 1);
}

TEST(OutlineOrders, WithoutInputsTheyAreJudgedOneStepAheadAndThereIsNoDelay) {
  const OutlineSummary summary = learned(made::outline_recording({.rows = 1500}), {.order = {}, .delay = {}});
  EXPECT_EQ(summary.choice.by, OutlineCriterion::kHeldOutStep);
  EXPECT_GE(summary.choice.taken().order, 2);
  EXPECT_LE(summary.choice.taken().order, 3);
  EXPECT_EQ(summary.choice.taken().delay, 0);
}

TEST(OutlineOrders, WithNothingHeldOutTheFinalPredictionErrorDecides) {
  const OutlineSummary summary = learned(made::outline_recording({.rows = 1500}), {.order = {}, .holdout = 0});
  EXPECT_EQ(summary.choice.by, OutlineCriterion::kFpe);
  EXPECT_LE(summary.choice.taken().order, 3);
}

// 120 frames cannot tell 32 lags of four channels: such candidates are not even tried.
TEST(OutlineOrders, AShortRecordingIsSearchedLessFar) {
  const OutlineSummary summary = learned(made::outline_recording({.rows = 160}), {.order = {}});
  EXPECT_LT(summary.choice.candidates.back().order, 16);
  EXPECT_LE(summary.choice.taken().order, 6);
}

TEST(OutlineOrders, EveryCouplingCanBeSearched) {
  for (const OutlineCoupling coupling : {OutlineCoupling::kBand, OutlineCoupling::kFull}) {
    const OutlineSummary summary = learned(made::outline_recording(kWindy), {.order = {}, .coupling = coupling});
    EXPECT_LE(summary.choice.taken().order, 6);
    EXPECT_NE(summary.choice.by, OutlineCriterion::kGiven);
  }
}

}  // namespace
}  // namespace wisp::outline_orders_test
