// Picture and sound joined.

#include "wisp/capture/capture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "capture/support/clip_files.hpp"

namespace wisp::capture_test {
namespace {

using support::ScratchFolder;
using testing::HasSubstr;

// Images of a swaying flame.
class Capture : public testing::Test {
 protected:
  void SetUp() override {
    for (int k = 0; k < 40; ++k) {
      support::write_pgm(folder_ / (std::to_string(100 + k) + ".pgm"), support::flame_picture(support::swaying(k)));
    }
  }

  Captured captured(const ClipCapture& options) {
    auto clip = capture(folder_.path(), options);
    EXPECT_TRUE(clip) << (clip ? "" : clip.error().message);
    return *std::move(clip);
  }

  ScratchFolder folder_{"capture"};
};

TEST_F(Capture, ReportsWhatItFound) {
  const Captured clip = captured({.rate_hz = 50});
  EXPECT_EQ(clip.recording.rows(), 40u);
  for (const char* id : {"frames", "tracked", "duplicates", "filled", "rate_hz", "points", "threshold", "channel",
                         "wind.heard", "wind.background", "wind.reason"}) {
    EXPECT_NE(clip.report.find(id), nullptr) << id;
  }
  const auto& heard = static_cast<const ReportValue::Base&>(clip.report.find("wind.heard")->value);
  EXPECT_FALSE(std::get<bool>(heard));
  EXPECT_EQ(clip.report.sections[1].series.front().y.size(), 256u);
}

TEST_F(Capture, AnotherClipsCurveOverridesTheNumberOfPoints) {
  const Captured twelve = captured({.points = 12, .rate_hz = 50});
  const auto curve = curve_of(twelve.recording);
  ASSERT_TRUE(curve);
  EXPECT_EQ(curve->knots.size(), 16u);
  const Captured other = captured({.rate_hz = 50, .curve = curve});
  EXPECT_EQ(curve_of(other.recording)->knots, curve->knots);
}

TEST_F(Capture, OptionsOutOfRangeAreRefused) {
  EXPECT_THAT(capture(folder_.path(), {.points = 3, .rate_hz = 50}).error().message, HasSubstr("expected 4 to 64"));
  EXPECT_THAT(capture(folder_.path(), {.frames = FrameRange{1, 400}, .rate_hz = 50}).error().message,
              HasSubstr("1:400"));
}

TEST_F(Capture, OnlyOutlinesHaveACurve) {
  EXPECT_FALSE(curve_of(Recording{}));
  EXPECT_FALSE(curve_of(Model{}));
  Recording broken = captured({.rate_hz = 50}).recording;
  set_numbers_attribute(broken, "knots", std::vector<double>{0, 1});
  EXPECT_FALSE(curve_of(broken));
}

}  // namespace
}  // namespace wisp::capture_test
