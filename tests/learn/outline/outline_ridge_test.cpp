#include "learn/outline/outline_ridge.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "learn/outline/made_outline.hpp"
#include "learn/outline/outline_fit.hpp"

namespace wisp::outline_ridge_test {
namespace {

// Control points that are shaken nearly alike: what one says its neighbours say too.
std::vector<Recording> nearly_alike() {
  return {made::outline_recording({.points = 8, .rows = 900, .shock = 0.003, .own_share = 0.02, .wind = true})};
}

OutlineSummary fitted(OutlineCoupling coupling) {
  const auto fit = fit_outline(nearly_alike(), {.coupling = coupling});
  EXPECT_TRUE(fit) << (fit ? "" : fit.error().message);
  return fit->summary;
}

TEST(OutlineRidge, PointsThatHearTheirNeighboursFollowTheInputAboutAsWellAsPointsAlone) {
  const OutlineSummary band = fitted(OutlineCoupling::kBand), point = fitted(OutlineCoupling::kPoint);
  EXPECT_GT(band.held_out->tip_fit_percent.back(), point.held_out->tip_fit_percent.back() - 5);
  EXPECT_FALSE(band.stable.changed);
  EXPECT_TRUE(band.usable.verdict) << band.usable.reason;
}

TEST(OutlineRidge, IsTheStableCandidateOfLeastHeldOutError) {
  const RidgeChoice choice = fitted(OutlineCoupling::kBand).ridge;
  ASSERT_GT(choice.candidates.size(), 3u);
  double least = 1e300;
  for (const RidgeCandidate& one : choice.candidates) {
    if (one.stable) least = std::min(least, one.error);
  }
  const auto taken = std::find_if(choice.candidates.begin(), choice.candidates.end(),
                                  [&](const RidgeCandidate& one) { return one.ridge == choice.ridge; });
  ASSERT_NE(taken, choice.candidates.end());
  EXPECT_TRUE(taken->stable);
  EXPECT_EQ(taken->error, least);
}

TEST(OutlineRidge, PointsAloneHaveNone) {
  const RidgeChoice choice = fitted(OutlineCoupling::kPoint).ridge;
  EXPECT_EQ(choice.ridge, 0);
  EXPECT_TRUE(choice.candidates.empty());
}

}  // namespace
}  // namespace wisp::outline_ridge_test
