#include "capture/capture_clip.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "capture/support/capture_outline.hpp"
#include "capture/support/clip_files.hpp"
#include "capture/support/overlap.hpp"

namespace wisp::capture_clip_test {
namespace {

using support::capture_outline;
using support::ClipCaptureOptions;
using support::ScratchFolder;
using testing::HasSubstr;

ClipCaptureOptions with_points(int points) {
  ClipCaptureOptions options;
  options.outline.points = points;
  return options;
}

Result<CapturedOutline> capture_real(const std::string& name, int points) {
  ClipCaptureOptions options = with_points(points);
  const auto path = support::real_data() / "flame" / name;
  if (std::filesystem::is_directory(path)) options.video.rate_hz = 30;
  return capture_outline(path, options);
}

// The mask's own place may reach this far beyond the curve.
constexpr int kAround = 100;

double overlap_of(const CapturedOutline& captured, const Picture& picture, const SplineTable& table, std::size_t row) {
  std::vector<double> controls;
  for (int i = 0; i < 2 * captured.report.points; ++i) controls.push_back(captured.recording.channels[i].samples[row]);
  double left = 1e9, top = 1e9, right = 0, bottom = 0;
  for (const CurvePoint p : curve_polyline(table, controls, 100)) {
    left = std::min(left, p.x);
    right = std::max(right, p.x);
    top = std::min(top, p.y);
    bottom = std::max(bottom, p.y);
  }
  const Region tight{static_cast<int>(left), static_cast<int>(top), static_cast<int>(right - left) + 2,
                     static_cast<int>(bottom - top) + 2};
  const Region place = intersection(grown(tight, kAround), picture.frame());
  std::vector<std::uint8_t> plane(static_cast<std::size_t>(place.width) * place.height);
  extract_channel(picture, captured.report.channel, place, plane.data());
  for (std::size_t i = 0; i < controls.size(); ++i) controls[i] -= i % 2 == 0 ? place.x : place.y;
  const int level = static_cast<int>(std::lround(captured.report.threshold));
  return support::overlap(support::region_mask({plane.data(), place.width, place.height, place.width}, level),
                          support::curve_mask(table, controls, place.width, place.height));
}

// Mean intersection over union over all rows with an outline of their own.
double mean_overlap(const CapturedOutline& captured, const std::filesystem::path& path, double rate_hz) {
  VideoOptions options;
  options.rate_hz = rate_hz;
  auto reader = VideoReader::open(path, options);
  const SplineTable table(captured.report.knots);
  double sum = 0;
  int count = 0;
  for (std::size_t row = 0; row < captured.recording.rows(); ++row) {
    const auto frame = reader->next();
    if (!frame || !frame->has_value()) break;
    if (std::isnan(captured.recording.channels[0].samples[row]) || captured.recording.flags[0].rows[row] != 0) continue;
    sum += overlap_of(captured, (*frame)->picture, table, row);
    ++count;
  }
  return sum / count;
}

TEST(CaptureClip, TracksAllFramesOfTheSwayingCandle) {
  const auto path = support::real_data() / "flame/candle_frames_144";
  WISP_NEEDS(path);
  for (const int points : {8, 16}) {
    const auto captured = capture_real("candle_frames_144", points);
    ASSERT_TRUE(captured) << captured.error().message;
    EXPECT_EQ(captured->report.tracked, 100u);
    EXPECT_GT(mean_overlap(*captured, path, 30), points == 8 ? 0.88 : 0.96) << points;
  }
}

TEST(CaptureClip, AccountsForAllFramesOfTheShakenFlame) {
  const auto path = support::real_data() / "flame/flame_shaken_1080p60.mp4";
  WISP_NEEDS(path);
  for (const int points : {8, 16}) {
    const auto captured = capture_real("flame_shaken_1080p60.mp4", points);
    ASSERT_TRUE(captured) << captured.error().message;
    const CaptureReport& report = captured->report;
    EXPECT_EQ(report.frames, 266u);
    EXPECT_EQ(report.duplicates, 27u);
    EXPECT_EQ(report.tracked + report.filled + report.dropped.size(), 266u);
    EXPECT_EQ(report.tracked, 239u);
    EXPECT_TRUE(report.usable) << report.reason;
    EXPECT_GT(mean_overlap(*captured, path, 0), points == 8 ? 0.93 : 0.97) << points;
  }
}

TEST(CaptureClip, KeepsTheCandleBodyOutAndDropsTheFades) {
  const auto path = support::real_data() / "flame/red_candle_720p25.mp4";
  WISP_NEEDS(path);
  for (const int points : {8, 16}) {
    const auto captured = capture_real("red_candle_720p25.mp4", points);
    ASSERT_TRUE(captured) << captured.error().message;
    std::vector<std::size_t> dropped;
    for (const DroppedFrame& frame : captured->report.dropped) dropped.push_back(frame.frame);
    EXPECT_EQ(dropped, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 251, 252, 253, 254, 255, 256}));
    EXPECT_GT(mean_overlap(*captured, path, 0), points == 8 ? 0.88 : 0.96) << points;
    // The wick's holder begins at row 450, the body is 290 pixels wide.
    const auto& base_y = captured->recording.channels[2 * points + 1].samples;
    for (const double y : base_y) EXPECT_FALSE(y > 460) << y;
    for (std::size_t row = 6; row < 251; ++row) {
      const double width =
          captured->recording.channels[2 * points - 2].samples[row] - captured->recording.channels[0].samples[row];
      EXPECT_LT(width, 80) << row;
    }
  }
}

TEST(CaptureClip, ReadsAFolderOfImagesAndSaysWhereItCameFrom) {
  ScratchFolder folder("clip");
  for (int k = 0; k < 40; ++k) {
    if (k == 25) continue;  // lost
    support::write_pgm(folder / (std::to_string(100 + k) + ".pgm"), support::flame_picture(support::swaying(k)));
  }
  ClipCaptureOptions options = with_points(8);
  options.video.rate_hz = 50;
  std::vector<double> shares;
  const auto captured = capture_outline(folder.path(), options, [&](std::string_view, double share) {
    shares.push_back(share);
    return true;
  });
  ASSERT_TRUE(captured) << captured.error().message;
  EXPECT_EQ(shares.size(), 39u);
  EXPECT_EQ(shares.back(), 1);
  EXPECT_EQ(captured->report.frames, 40u);
  EXPECT_EQ(captured->report.filled, 1u);
  EXPECT_DOUBLE_EQ(captured->recording.rate_hz, 50);
  EXPECT_EQ(find_attribute(captured->recording, "source"), folder.path().string());
}

TEST(CaptureClip, CanBeStopped) {
  ScratchFolder folder("stop");
  for (int k = 0; k < 30; ++k) {
    support::write_pgm(folder / (std::to_string(k) + ".pgm"), support::flame_picture(support::swaying(k)));
  }
  ClipCaptureOptions options = with_points(8);
  options.video.rate_hz = 50;
  const auto captured =
      capture_outline(folder.path(), options, [](std::string_view, double share) { return share < 0.2; });
  ASSERT_FALSE(captured);
  EXPECT_EQ(captured.error().message, kStopped);
}

TEST(CaptureClip, HalfAClipIsUsedWithAWarning) {
  const auto path = support::real_data() / "flame/red_candle_720p25.mp4";
  WISP_NEEDS(path);
  ScratchFolder folder("halfclip");
  std::filesystem::copy_file(path, folder / "half.mp4");
  std::filesystem::permissions(folder / "half.mp4", std::filesystem::perms::owner_all);
  std::filesystem::resize_file(folder / "half.mp4", std::filesystem::file_size(path) / 2);
  const auto captured = capture_outline(folder / "half.mp4", with_points(8));
  ASSERT_TRUE(captured) << captured.error().message;
  EXPECT_GT(captured->report.tracked, 90u);
  ASSERT_FALSE(captured->report.warnings.empty());
}

TEST(CaptureClip, AFlagSeenEdgeOnIsADarkLineHeldOnTheLeft) {
  const auto path = support::real_data() / "flag/fullVeloc_7.64_60fps_rv.mp4";
  WISP_NEEDS(path);
  ClipCaptureOptions options = with_points(8);
  options.outline.dark = true;
  options.video.frames = FrameRange{1, 120};
  const auto captured = capture_outline(path, options);
  ASSERT_TRUE(captured) << captured.error().message;
  EXPECT_GT(captured->report.tracked, 100u);
  // p0 at the left border, the tip (the fourth or fifth control point) far to the right.
  EXPECT_LT(captured->recording.channels[0].samples[5], 20);
  EXPECT_GT(captured->recording.channels[6].samples[5], 300);
}

}  // namespace
}  // namespace wisp::capture_clip_test
