// What of a recording's residuals is kept to be played again, and about which point.

#include "learn/outline/resampled_residuals.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "learn/outline/made_outline.hpp"
#include "learn/outline/outline_fit.hpp"

namespace wisp::resampled_residuals_test {
namespace {

constexpr made::OutlineRecipe kWindy{.rows = 900, .wind = true};

OutlineFit learned(const made::OutlineRecipe& recipe, const OutlineRecipe& options = {}) {
  auto fit = fit_outline(std::vector{made::outline_recording(recipe)}, options);
  EXPECT_TRUE(fit);
  return *std::move(fit);
}

const ArxModel& dynamics_of(const OutlineFit& fit) { return std::get<ArxModel>(fit.model.dynamics); }

TEST(OutlineDrawn, AreTheNoiseOfShapesAlone) {
  const OutlineFit fit = learned(kWindy);
  const ResampledResiduals& resampled = dynamics_of(fit).noise.resampled;
  EXPECT_GT(resampled.row_count(), 850u);
  EXPECT_EQ(resampled.toward, 3);  // after the wind's size, its root and its square
  EXPECT_EQ(resampled.mirror.size(), resampled.scale.size());
  EXPECT_GT(resampled.mirror.front(), 0);
  EXPECT_LT(resampled.mirror.back(), 0);
  EXPECT_EQ(dynamics_of(learned({.rows = 900})).noise.resampled.toward, -1);
  EXPECT_TRUE(dynamics_of(learned(kWindy, {.paper = 4})).noise.resampled.empty());
}

TEST(OutlineDrawn, KeepsResidualsToTheirEightBits) {
  const OutlineFit fit = learned(kWindy);
  const ArxModel& arx = dynamics_of(fit);
  const ResampledResiduals& resampled = arx.noise.resampled;
  const std::size_t ny = resampled.scale.size();
  for (std::size_t i = 0; i < ny; ++i) {
    double square = 0;
    for (std::size_t row = 0; row < resampled.row_count(); ++row)
      square += std::pow(resampled.rows[row * ny + i] * resampled.scale[i], 2);
    const double sd = std::sqrt(square / static_cast<double>(resampled.row_count()));
    EXPECT_NEAR(sd, arx.noise.sd[i], 0.05 * arx.noise.sd[i]) << i;
  }
}

// The first gust of a stretch begins it: what stands still in calm is not taken into a gust that it does not feel.
TEST(OutlineDrawn, WhatWasRecordedInCalmEndsWhereItBeginsToBlow) {
  const OutlineFit fit = learned(kWindy);
  const ResampledResiduals& resampled = dynamics_of(fit).noise.resampled;
  std::size_t begin = 0, calm = 0, abated = 0, stretch = 0;
  for (const std::size_t end : resampled.ends) {
    const std::size_t before = ++stretch * static_cast<std::size_t>(resampled.lags.back());
    const auto wind = [&](std::size_t row) { return std::abs(resampled.winds[before + row] * resampled.wind_scale); };
    for (std::size_t row = begin + 1; row < end; ++row) {
      calm += wind(row) <= 0.039 ? 1 : 0;
      abated += wind(row - 1) > 0.041 && wind(row) <= 0.039 ? 1 : 0;
      EXPECT_FALSE(wind(row - 1) <= 0.039 && wind(row) > 0.041) << row;
    }
    begin = end;
  }
  EXPECT_GT(calm, 100u);
  EXPECT_GT(abated, 2u);
  EXPECT_GT(resampled.ends.size(), 5u);
}

// What blew before the first row of a stretch is known too: a jump may lead there.
TEST(OutlineDrawn, EveryStretchHasTheWindBeforeIt) {
  const OutlineFit fit = learned(kWindy);
  const ResampledResiduals& resampled = dynamics_of(fit).noise.resampled;
  const auto past = static_cast<std::size_t>(resampled.lags.back());
  EXPECT_EQ(past, 5u);  // 0.15 s at 30 rows a second
  ASSERT_EQ(resampled.winds.size(), resampled.row_count() + resampled.ends.size() * past);
  // Stretches that were cut where it began to blow go on where the one before ended.
  for (std::size_t s = 0; s + 1 < resampled.ends.size(); ++s) {
    const std::size_t end = resampled.ends[s];
    const std::size_t last = end - 1 + (s + 1) * past, before = end + (s + 2) * past - 1;
    EXPECT_EQ(resampled.winds[before], resampled.winds[last]) << s;
  }
}

}  // namespace
}  // namespace wisp::resampled_residuals_test
