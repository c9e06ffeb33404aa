#include "capture/vision/outline_rows.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "capture/vision/outline_verdict_weights.hpp"
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
  report.facts.light = 1;
  report.facts.film.pictures = kRows;
  report.facts.steadiness = 0.9;
  EXPECT_TRUE(gather_facts(recording, SplineTable(uniform_knots(static_cast<int>(outline.size()))), report));
  judge_outline(report);
  return report;
}

const Outline kFlame{{-12, 0}, {-22, 20}, {-20, 60}, {-6, 110}, {6, 110}, {20, 60}, {22, 20}, {12, 0}};

TEST(OutlineVerdict, AFlameThatSwaysIsUsable) {
  const CaptureReport report = judged(kFlame);
  EXPECT_TRUE(report.usable) << report.reason;
}

TEST(OutlineVerdict, WhatHasRunTogetherWithTheWaxThatItLightsIsNoFlame) {
  Outline outline = kFlame;
  outline[1] = {-110, 2};
  outline[2] = {-4, 20};
  outline[5] = {4, 20};
  outline[6] = {110, 2};
  const CaptureReport report = judged(outline);
  EXPECT_FALSE(report.usable);
  EXPECT_THAT(report.reason, HasSubstr("its shape is not a flame's"));
}

TEST(OutlineVerdict, WhatNeverLookedLitIsNoFlameInGlare) {
  CaptureReport report = judged(kFlame, 60);
  report.facts.wander = 6;
  judge_outline(report);
  EXPECT_LT(report.likely_flame, 0.5);
  EXPECT_THAT(report.reason, HasSubstr("its shape is not a flame's"));
  EXPECT_THAT(report.reason, testing::Not(HasSubstr("there is no flame")));
  report.facts.burns = false;
  judge_outline(report);
  EXPECT_THAT(report.reason, HasSubstr("there is no flame in the film: its shape is not a flame's"));
}

TEST(OutlineVerdict, WhatIsAsWideAsHighIsNoFlame) {
  Outline outline = kFlame;
  for (CurvePoint& p : outline) p.x *= 2.6;
  const CaptureReport report = judged(outline);
  EXPECT_FALSE(report.usable);
  EXPECT_GT(report.facts.width, 0.8);
  EXPECT_THAT(report.reason, HasSubstr("its shape is not a flame's"));
}

TEST(OutlineVerdict, AFlameThatLiesOnItsSideIsInAFilmThatIsTurned) {
  for (const int side : {-1, 1}) {
    Outline outline = kFlame;
    for (CurvePoint& p : outline) p = {side * p.y, 20 - side * p.x};
    CaptureReport report = judged(outline);
    report.facts.movement = 0.1;  // it flickers as one that stands
    judge_outline(report);
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
  EXPECT_TRUE(judged(kFlame, 1).usable);
  EXPECT_FALSE(judged(kFlame, 2).usable);
}

CaptureReport with(void (*change)(CaptureReport&)) {
  CaptureReport report = judged(kFlame);
  change(report);
  judge_outline(report);
  return report;
}

TEST(OutlineVerdict, EveryFaultOfAFilmIsItsOwnReason) {
  struct Case {
    const char* name;
    void (*change)(CaptureReport&);
    const char* said;
  };
  const Case cases[] = {
      {"lost", [](CaptureReport& r) { r.facts.lost = 0.35; }, "its frames come irregularly, 35 %"},
      {"repeated", [](CaptureReport& r) { r.facts.repeated = 0.5, r.facts.stands = 2; }, "every frame stands 2 times"},
      {"cut", [](CaptureReport& r) { r.frames = 120, r.facts.other_after = 60; }, "in 50 % of the frames it is gone"},
      {"missing", [](CaptureReport& r) { r.facts.absent = 15; }, "it is missing in 25 %"},
      {"jumps", [](CaptureReport& r) { r.facts.jumps = 0.3; }, "it jumps in 30 %"},
      {"border",
       [](CaptureReport& r) {
         r.facts.border = {0, 0, 1, 0};
       },
       "it reaches the right border"},
  };
  for (const Case& one : cases) {
    const CaptureReport report = with(one.change);
    EXPECT_FALSE(report.usable) << one.name;
    EXPECT_GT(report.likely_flame, 0.5) << one.name;
    EXPECT_THAT(report.reason, HasSubstr(one.said)) << one.name;
  }
}

TEST(OutlineVerdict, AStillLampUnderACodersNoiseIsNoFlame) {
  const CaptureReport report = with([](CaptureReport& r) {  // of a bulb, coded as MPEG-4
    r.facts.movement = 0.0095, r.facts.edge_noise = 0.9, r.facts.wander = 1.2;
    r.facts.steadiness = 0.42, r.facts.light = 0.93;
  });
  EXPECT_FALSE(report.usable);
  EXPECT_LT(report.likely_flame, 0.5);
  EXPECT_THAT(report.reason, HasSubstr("there is no flame"));
}

// A worse fact never makes the verdict better: every curve is monotone, and none gives anything.
TEST(OutlineVerdict, IsMonotoneInEveryFact) {
  for (const VerdictCurve& curve : kVerdictCurves) {
    for (const auto& against : {curve.against_flame, curve.against_right}) {
      const bool rising = std::is_sorted(against.begin(), against.end());
      EXPECT_TRUE(rising || std::is_sorted(against.rbegin(), against.rend()));
      EXPECT_EQ(rising ? against.front() : against.back(), 0);
    }
    EXPECT_TRUE(std::is_sorted(curve.knots.begin(), curve.knots.end()));
  }
}

}  // namespace
}  // namespace wisp::outline_verdict_test
