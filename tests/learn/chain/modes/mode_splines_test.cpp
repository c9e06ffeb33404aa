#include "learn/chain/modes/mode_splines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <span>

#include "learn/chain/chain_fit.hpp"
#include "learn/chain/made_falls.hpp"
#include "model/sample_chain.hpp"
#include "wisp/model/file.hpp"

namespace wisp::chain::mode_splines_test {
namespace {

ChainModel& chain(Model& model) { return std::get<ChainModel>(model.dynamics); }

// Forty segments of one mode, of 6 to 17 steps: cubics of their time that differ in two ways.
ChainModel cubics() {
  Model model = sample_chain(ChainMotion::kPosition);
  ChainModel out = chain(model);
  out.modes = 1;
  out.initial = {1};
  out.contexts = {{{0}, {1.0}}};
  ChainSegments& segments = out.segments;
  segments = {.row_scale = {1e-5}, .rate_scale = {1e-4}};
  for (int k = 0; k < 40; ++k) {
    const int steps = 6 + k % 12;
    segments.mode.push_back(0);
    segments.steps.push_back(static_cast<std::uint16_t>(steps));
    segments.rates.resize(segments.rates.size() + 6);
    for (int step = 0; step <= steps; ++step) {
      const double t = static_cast<double>(step) / steps, bend = t * t * (1 - t);
      for (double x : {9000 * t + 300 * (k % 7) * bend, 200.0 * (k % 5 - 2) * t * t, -8000 * t * t * t})
        segments.rows.push_back(static_cast<std::int16_t>(std::lround(x)));
    }
  }
  return out;
}

// Square of the difference of two rows, of which quaternions say the same with either sign.
double squared_difference(std::span<const std::int16_t> a, std::span<const std::int16_t> b) {
  double along = 0, sum = 0;
  for (std::size_t k = 3; k < a.size(); ++k) along += static_cast<double>(a[k]) * b[k];
  for (std::size_t k = 0; k < a.size(); ++k) sum += std::pow(a[k] - (k >= 3 && along < 0 ? -1.0 : 1.0) * b[k], 2);
  return sum;
}

// Root-mean-square difference of rows, in what they are stored in.
double misfit(const ChainModel& a, const ChainModel& b) {
  const auto width = static_cast<std::size_t>(channel_count(a.motion));
  const std::span<const std::int16_t> before = a.segments.rows, after = b.segments.rows;
  double sum = 0;
  for (std::size_t row = 0; row < before.size(); row += width) {
    sum += squared_difference(before.subspan(row, width), after.subspan(row, width));
  }
  return std::sqrt(sum / static_cast<double>(before.size()));
}

TEST(ModeSplines, SegmentsThatDifferInTwoWaysAreMadeOfTwoComponents) {
  const ChainModel before = cubics();
  ChainModel after = before;
  as_splines(after, {.components = 2, .stiffness = 1e-9});
  ASSERT_TRUE(check(after));
  // Rounding to whole numbers, twice.
  EXPECT_LT(misfit(before, after), 0.6);
  ChainModel mean = before;
  as_splines(mean, {.components = 0});
  EXPECT_GT(misfit(before, mean), 50);
}

TEST(ModeSplines, WithoutComponentsASegmentIsItsModesMean) {
  ChainModel after = cubics();
  as_splines(after, {.components = 0});
  const auto first = segment_rows(after.segments);
  // Segments 0 and 12 have six steps.
  for (std::size_t k = 0; k < 7 * 3; ++k) {
    EXPECT_EQ(after.segments.rows[3 * first[0] + k], after.segments.rows[3 * first[12] + k]);
  }
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(after.segments.rows[k], 0);
}

TEST(ModeSplines, OfFallsTakeLessRoomAndFitBetterTheMoreComponentsThereAre) {
  const Recording recording = made_falls({.falls = 40});
  const auto fit = fit_chain(std::span(&recording, 1), {.event = {}, .modes = 3, .restarts = 1});
  ASSERT_TRUE(fit) << fit.error().message;
  Model model = fit->model;
  const ChainModel before = chain(model);
  double last = 1e9;
  for (int components : {0, 3, 12}) {
    chain(model) = before;
    as_splines(chain(model), {.components = components});
    ASSERT_TRUE(check(chain(model)));
    const double now = misfit(before, chain(model));
    EXPECT_LT(now, 0.7 * last) << components;
    last = now;
  }
  // A hundredth of a quaternion's length, and of the farthest that a segment goes.
  EXPECT_LT(last, 327);
  EXPECT_LT(model_bytes(model)->size(), model_bytes(fit->model)->size());
}

}  // namespace
}  // namespace wisp::chain::mode_splines_test
