#include "capture/vision/outline_verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "model/bspline.hpp"

namespace wisp::outline_verdict_test {
namespace {

using testing::HasSubstr;

using Outline = std::vector<CurvePoint>;

// Sways above (200, 300); `outline` in pixels, y up.
CaptureReport judged(const Outline& outline, double residual = 0.5) {
  constexpr std::size_t kRows = 60;
  Recording recording;
  recording.rate_hz = 30;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    std::vector<double> x(kRows), y(kRows);
    for (std::size_t row = 0; row < kRows; ++row) {
      const double lean = 0.1 * std::sin(0.4 * static_cast<double>(row));
      x[row] = 200 + outline[k].x + lean * outline[k].y;
      y[row] = 300 - outline[k].y;
    }
    const std::string name = "p" + std::to_string(k);
    recording.channels.push_back({.name = name + ".x", .unit = "px", .role = Role::kOutput, .samples = x});
    recording.channels.push_back({.name = name + ".y", .unit = "px", .role = Role::kOutput, .samples = y});
  }
  CaptureReport report;
  report.frames = report.tracked = kRows;
  report.rate_hz = 30;
  report.width = 400;
  report.height = 320;
  report.flames = 1;
  report.points = static_cast<int>(outline.size());
  report.residual = residual;
  report.facts.light = report.facts.solidity = 1;
  report.facts.narrowing = 0.6;
  judge_outline(recording, SplineTable(uniform_knots(static_cast<int>(outline.size()))), report);
  return report;
}

const Outline kFlame{{-12, 0}, {-22, 20}, {-20, 60}, {-6, 110}, {6, 110}, {20, 60}, {22, 20}, {12, 0}};

TEST(OutlineVerdict, AFlameThatSwaysIsUsable) {
  const CaptureReport report = judged(kFlame);
  EXPECT_TRUE(report.usable) << report.reason;
  EXPECT_EQ(report.facts.ragged, 0);
}

TEST(OutlineVerdict, WhatHasRunTogetherWithTheWaxThatItLightsIsNoFlame) {
  Outline outline = kFlame;
  outline[1] = {-110, 2};
  outline[2] = {-4, 20};
  outline[5] = {4, 20};
  outline[6] = {110, 2};
  const CaptureReport report = judged(outline);
  EXPECT_FALSE(report.usable);
  EXPECT_EQ(report.facts.ragged, 1);
  EXPECT_THAT(report.reason, HasSubstr("its shape is not a flame's"));
}

TEST(OutlineVerdict, WhatIsAsWideAsHighIsNoFlame) {
  Outline outline = kFlame;
  for (CurvePoint& p : outline) p.x *= 2.6;
  const CaptureReport report = judged(outline);
  EXPECT_FALSE(report.usable);
  EXPECT_EQ(report.facts.ragged, 0);
  EXPECT_GT(report.facts.width, 0.8);
  EXPECT_THAT(report.reason, HasSubstr("its shape is not a flame's"));
}

TEST(OutlineVerdict, AFlameThatLiesOnItsSideIsInAFilmThatIsTurned) {
  for (const int side : {-1, 1}) {
    Outline outline = kFlame;
    for (CurvePoint& p : outline) p = {side * p.y, 20 - side * p.x};
    const CaptureReport report = judged(outline);
    EXPECT_FALSE(report.usable);
    EXPECT_NEAR(report.facts.lean, 90, 1);
    EXPECT_THAT(report.reason, HasSubstr("it lies on its side, 90 degrees from upright"));
  }
}

TEST(OutlineVerdict, AFlameThatLeansIsNotOneThatLies) {
  Outline outline = kFlame;
  for (CurvePoint& p : outline) p.x += 0.6 * p.y;
  const CaptureReport report = judged(outline);
  EXPECT_TRUE(report.usable) << report.reason;
  EXPECT_NEAR(report.facts.lean, 31, 2);
}

TEST(OutlineVerdict, AnEdgeThatTheCurveDoesNotFollowIsNoFlames) {
  EXPECT_TRUE(judged(kFlame, 1.5).usable);
  const CaptureReport report = judged(kFlame, 2);  // 0.018 of its height; eight points may miss 0.0125, and noise
  EXPECT_FALSE(report.usable);
  EXPECT_THAT(report.reason, HasSubstr("its shape is not a flame's"));
}

}  // namespace
}  // namespace wisp::outline_verdict_test
