#include "learn/outline/outline_preparation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "learn/outline/made_outline.hpp"
#include "learn/outline/outline_shape.hpp"
#include "model/bspline.hpp"

namespace wisp::outline_knots_test {
namespace {

std::vector<double> control_of(const Recording& recording, std::size_t row) {
  std::vector<double> control;
  const OutlineLayout layout = *outline_layout(recording);
  for (std::size_t c : layout.outputs) control.push_back(recording.channels[c].samples[row]);
  return control;
}

const std::vector<double> kOther = clamped_knots(std::vector<double>{0.25, 0.45, 0.55, 0.75});

TEST(OutlineKnots, TheCurveStaysWhereItWas) {
  const Recording recording = made::outline_recording({.points = 8, .rows = 50});
  const OutlineLayout layout = *outline_layout(recording);
  const Reknotted other = with_knots(recording, layout, kOther);
  EXPECT_EQ(outline_layout(other.recording)->knots, kOther);
  // 200 pixels high: half a per cent.
  EXPECT_LT(other.rms, 1);
  EXPECT_GT(other.rms, 0);
  const auto before = OutlineCurve(layout.knots).polyline(control_of(recording, 10));
  const auto after = OutlineCurve(kOther).polyline(control_of(other.recording, 10));
  EXPECT_GT(overlap_of(before, after), 0.98);
  EXPECT_EQ(before.front(), after.front());
  EXPECT_NEAR(before.back()[0], after.back()[0], 1e-9);
}

TEST(OutlineKnots, TheSameKnotsChangeNothing) {
  const Recording recording = made::outline_recording({.points = 8, .rows = 5});
  const OutlineLayout layout = *outline_layout(recording);
  const Reknotted same = with_knots(recording, layout, layout.knots);
  EXPECT_LT(same.rms, 1e-9);
  for (std::size_t k = 0; k < 16; ++k) EXPECT_NEAR(control_of(recording, 3)[k], control_of(same.recording, 3)[k], 1e-8);
}

TEST(OutlineKnots, MissingRowsStayMissing) {
  Recording recording = made::outline_recording({.points = 8, .rows = 5});
  recording.channels[3].samples[2] = std::numeric_limits<double>::quiet_NaN();
  const Reknotted other = with_knots(recording, *outline_layout(recording), kOther);
  EXPECT_TRUE(std::isnan(other.recording.channels[3].samples[2]));
  EXPECT_FALSE(std::isnan(other.recording.channels[3].samples[3]));
}

}  // namespace
}  // namespace wisp::outline_knots_test
