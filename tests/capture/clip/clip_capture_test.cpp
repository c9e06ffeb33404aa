#include "wisp/capture/clip/clip_capture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "capture/support/synthetic.hpp"

namespace wisp::clip_capture_test {
namespace {

using support::Plane;
using testing::HasSubstr;

constexpr double kRate = 30;
constexpr int kFrames = 90;
constexpr SoundFormat kSound{.rate_hz = 8000, .channels = 1};

Plane flame(int k) {
  Plane plane = support::flame_picture(support::swaying(k));
  std::mt19937 random(static_cast<unsigned>(k) + 1);
  for (auto& pixel : plane.pixels) {
    pixel = static_cast<std::uint8_t>(std::clamp(pixel + static_cast<int>(random() % 5) - 2, 0, 255));
  }
  return plane;
}

LiveCapture live_flame(int frames = kFrames, bool pictures = false, const ClipCapture& options = {}) {
  auto live = LiveCapture::create({.name = "camera", .rate_hz = kRate, .pictures = pictures}, options);
  EXPECT_TRUE(live);
  for (int k = 0; k < frames; ++k) {
    const Plane plane = flame(k);
    EXPECT_TRUE(live->picture().feed(grey_picture(plane.view())));
  }
  return std::move(*live);
}

// Rushing air: noise that is loud in the second half.
std::vector<float> rushing(double seconds) {
  std::mt19937 random(5);
  std::vector<float> samples(static_cast<std::size_t>(seconds * kSound.rate_hz));
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double loud = k < samples.size() / 2 ? 0.001 : 0.2;
    samples[k] = static_cast<float>(loud * (static_cast<double>(random()) / 2147483648.0 - 1));
  }
  return samples;
}

std::size_t missing_wind(const Recording& recording) {
  const auto& samples = recording.channels[*find_channel(recording, "wind")].samples;
  return static_cast<std::size_t>(
      std::count_if(samples.begin(), samples.end(), [](double x) { return std::isnan(x); }));
}

TEST(LiveCapture, JoinsWhatIsSeenWithWhatIsHeard) {
  LiveCapture live = live_flame();
  for (const double begin : {0.0, 2.0}) ASSERT_TRUE(live.hear(kSound, begin, rushing(2)));
  const auto captured = live.finish();
  ASSERT_TRUE(captured) << captured.error().message;
  EXPECT_EQ(captured->recording.rows(), kFrames);
  EXPECT_EQ(captured->recording.channels.front().name, "wind");
  EXPECT_EQ(missing_wind(captured->recording), 0U);
  EXPECT_TRUE(captured->report.verdict.has_value());
}

TEST(LiveCapture, LeavesTheWindMissingWhereTheSoundHasEnded) {
  LiveCapture live = live_flame();
  ASSERT_TRUE(live.hear(kSound, 0, rushing(2)));
  const auto captured = live.finish();
  ASSERT_TRUE(captured) << captured.error().message;
  EXPECT_EQ(missing_wind(captured->recording), kFrames - 60U);
  EXPECT_THAT(captured->report.warnings, testing::Contains(HasSubstr("the sound ends 30 frames before the picture")));
}

TEST(LiveCapture, CountsSoundFromTheFirstFrame) {
  // Half a second of it came before the first frame, or a whole second is missing there and is missing in the wind.
  for (const auto& [begin, covered] : {std::pair{-0.5, 45U}, {1.0, 60U}}) {
    LiveCapture live = live_flame();
    ASSERT_TRUE(live.hear(kSound, begin, rushing(2)));
    const auto captured = live.finish();
    ASSERT_TRUE(captured) << captured.error().message;
    EXPECT_EQ(missing_wind(captured->recording), kFrames - covered) << begin;
  }
}

TEST(LiveCapture, CountsMissingWindInTheRangeOfFramesOnly) {
  ClipCapture options;
  options.frames = FrameRange{31, 30 + kFrames};
  LiveCapture live = live_flame(kFrames, false, options);
  ASSERT_TRUE(live.hear(kSound, 1, rushing(3)));  // begins with frame 31
  const auto captured = live.finish();
  ASSERT_TRUE(captured) << captured.error().message;
  EXPECT_EQ(missing_wind(captured->recording), 0U);
  EXPECT_THAT(captured->report.warnings, testing::Not(testing::Contains(HasSubstr("missing"))));
}

TEST(LiveCapture, LeavesTheWindMissingInAHoleOfTheSound) {
  const auto wind_of = [](double second_begins) {
    LiveCapture live = live_flame();
    const auto sound = rushing(2);
    const std::size_t half = sound.size() / 2;
    EXPECT_TRUE(live.hear(kSound, 0, std::span(sound).first(half)));
    EXPECT_TRUE(live.hear(kSound, second_begins, std::span(sound).subspan(half)));
    const auto captured = live.finish();
    return captured->recording.channels[*find_channel(captured->recording, "wind")].samples;
  };
  const auto whole = wind_of(1.02), holed = wind_of(2);  // a jitter is no hole
  for (std::size_t row = 0; row < 30; ++row) {
    EXPECT_EQ(holed[row], whole[row]) << row;
    EXPECT_TRUE(std::isnan(holed[row + 30])) << row;
    EXPECT_EQ(holed[row + 60], whole[row + 30]) << row;
  }
}

TEST(LiveCapture, LeavesOutSoundThatComesTwice) {
  LiveCapture live = live_flame();
  ASSERT_TRUE(live.hear(kSound, 0, rushing(3)));
  ASSERT_TRUE(live.hear(kSound, 0, rushing(3)));
  const auto captured = live.finish();
  ASSERT_TRUE(captured) << captured.error().message;
  EXPECT_EQ(captured->recording.rows(), kFrames);
}

TEST(LiveCapture, InterpolatesOutlinesOfFramesThatWereNotInTheirPlaces) {
  const auto even = live_flame().finish();
  std::vector<float> offsets(kFrames, 0.5F);  // each came half a frame late
  const auto late = live_flame().finish({.offsets = offsets});
  ASSERT_TRUE(late) << late.error().message;
  const auto& before = even->recording.channels[0].samples;
  const auto& after = late->recording.channels[0].samples;
  for (std::size_t row = 20; row < 40; ++row) EXPECT_NEAR(after[row], 0.5 * (before[row - 1] + before[row]), 1e-9);
  offsets.assign(kFrames, 4);
  const auto far = live_flame().finish({.offsets = offsets});
  EXPECT_FALSE(far->report.verdict->usable);
  EXPECT_THAT(far->report.verdict->reason, HasSubstr("up to 4.0 places from where they should be, at most 3.0"));
}

TEST(LiveCapture, IsNotUsableWithSoundWhereAHoleInThePictureWasShortened) {
  LiveCapture live = live_flame();
  ASSERT_TRUE(live.hear(kSound, 0, rushing(4)));
  const auto captured = live.finish({.shortened = 1});
  EXPECT_FALSE(captured->report.verdict->usable);
  EXPECT_THAT(captured->report.verdict->reason, HasSubstr("holes of more than 2 s (1)"));
}

TEST(LiveCapture, WithoutSoundSaysThatOnlyFlickerIsLeft) {
  const auto captured = live_flame().finish();
  ASSERT_TRUE(captured) << captured.error().message;
  EXPECT_FALSE(find_channel(captured->recording, "wind"));
  EXPECT_THAT(captured->report.warnings, testing::Contains(HasSubstr("only flicker can be learned")));
  const auto pictures = live_flame(kFrames, true).finish();
  ASSERT_TRUE(pictures) << pictures.error().message;
  EXPECT_THAT(pictures->report.warnings, testing::Not(testing::Contains(HasSubstr("flicker"))));
}

TEST(LiveCapture, RefusesWhatCannotBe) {
  const auto points = LiveCapture::create({.name = "camera", .rate_hz = kRate}, [] {
    ClipCapture options;
    options.points = 3;
    return options;
  }());
  ASSERT_FALSE(points);
  EXPECT_THAT(points.error().message, HasSubstr("camera: points is 3, expected 4 to 64"));
  for (const double rate : {0.0, -30.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(LiveCapture::create({.name = "camera", .rate_hz = rate}));
  }
  LiveCapture live = live_flame(20);
  const auto heard = live.hear({.rate_hz = 10, .channels = 1}, 0, std::vector<float>(8));
  ASSERT_FALSE(heard);
  EXPECT_THAT(heard.error().message, HasSubstr("camera: its sound cannot be used"));
}

TEST(OutlineSeen, IsEmptyUntilPlaceAndLevelAreDecidedAndThenShowsTheOutline) {
  auto live = LiveCapture::create({.name = "camera", .rate_hz = kRate});
  ASSERT_TRUE(live);
  OutlineCapture& picture = live->picture();
  EXPECT_FALSE(picture.seen().decided);
  for (int k = 0; k < 60; ++k) {
    const Plane plane = flame(k);
    ASSERT_TRUE(picture.feed(grey_picture(plane.view())));
  }
  const OutlineSeen seen = picture.seen();
  EXPECT_EQ(seen.frames, 60U);
  ASSERT_TRUE(seen.decided);
  ASSERT_EQ(seen.polyline.size(), 128U);
  for (std::size_t k = 0; k < seen.polyline.size(); k += 2) {
    EXPECT_NEAR(seen.polyline[k], seen.found.x + seen.found.width / 2.0, seen.found.width);
    EXPECT_NEAR(seen.polyline[k + 1], seen.found.y + seen.found.height / 2.0, seen.found.height);
  }
  picture.lost();
  EXPECT_TRUE(picture.seen().polyline.empty());
}

}  // namespace
}  // namespace wisp::clip_capture_test
