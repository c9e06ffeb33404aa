#include "learn/outline/outline_turns.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "learn/arx/fit/arx_fit.hpp"
#include "learn/outline/made_outline.hpp"
#include "learn/outline/outline_fit.hpp"
#include "learn/outline/outline_orders.hpp"

namespace wisp::outline_turns_test {
namespace {

// Slow at first, from the cut on a flutter of nearly half the frame rate.
Recording calm_then_fluttering(std::size_t rows, std::size_t cut) {
  Recording recording = made::outline_recording({.rows = rows, .seed = 5});
  const Recording other = made::outline_recording({.rows = rows, .lag1 = -1.5, .seed = 6});
  for (std::size_t c = 0; c < recording.channels.size(); ++c) {
    auto& samples = recording.channels[c].samples;
    for (std::size_t row = cut; row < rows; ++row) samples[row] = other.channels[c].samples[row];
  }
  return recording;
}

TEST(OutlineTurns, EveryRowIsHeldOutOnceAndJudged) {
  const auto prepared = prepare_outlines(std::vector{made::outline_recording({.rows = 1000})}, {});
  ASSERT_TRUE(prepared);
  std::vector<int> held_out(1000, 0);
  const ArxOrders orders = outline_orders(2, 0, OutlineCoupling::kPoint, *prepared);
  const auto estimate = [&](std::span<const Recording> recordings) -> Result<ArxModel> {
    const auto& samples = recordings[0].channels[prepared->layout.outputs[4]].samples;
    for (std::size_t row = 0; row < samples.size(); ++row) held_out[row] += std::isnan(samples[row]) ? 1 : 0;
    auto fit = fit_arx(recordings, prepared->channels, {.orders = orders});
    if (!fit) return fit.error();
    return fit->model;
  };
  const auto figures = figures_in_turn(estimate, *prepared, 3);
  ASSERT_TRUE(figures) << figures.error().message;
  EXPECT_EQ(held_out, std::vector<int>(1000, 1));
  EXPECT_EQ(figures->rows, 998u);  // all but the first two, which have no history
  EXPECT_GT(figures->tip_fit_percent[0], 60);
}

TEST(OutlineTurns, AnEstimateThatFailsIsAnError) {
  const auto prepared = prepare_outlines(std::vector{made::outline_recording({.rows = 100})}, {});
  const auto figures = figures_in_turn([](auto) -> Result<ArxModel> { return Error{"no"}; }, *prepared, 2);
  ASSERT_FALSE(figures);
  EXPECT_EQ(figures.error().message, "no");
}

TEST(OutlineTurns, AFlickerThatChangesIsJudgedOnAllOfIt) {
  const std::vector recordings{calm_then_fluttering(1200, 840)};
  const auto by_its_end = fit_outline(recordings, {.refit = false});
  const auto in_turn = fit_outline(recordings);
  ASSERT_TRUE(by_its_end && in_turn);
  EXPECT_LT(by_its_end->summary.held_out->tip_fit_percent[0], 0);
  EXPECT_GT(in_turn->summary.held_out->tip_fit_percent[0], 20);
  EXPECT_EQ(in_turn->summary.rows_held_out, 400u);
  EXPECT_EQ(in_turn->summary.rows_learned, 800u);
}

TEST(OutlineTurns, WhatIsJudgedInTurnIsLearnedFromAllOfIt) {
  const std::vector recordings{made::outline_recording({.rows = 600})};
  const auto in_turn = fit_outline(recordings);
  const auto of_everything = fit_outline(recordings, {.holdout = 0});
  ASSERT_TRUE(in_turn && of_everything);
  EXPECT_EQ(std::get<ArxModel>(in_turn->model.dynamics).theta, std::get<ArxModel>(of_everything->model.dynamics).theta);
}

}  // namespace
}  // namespace wisp::outline_turns_test
