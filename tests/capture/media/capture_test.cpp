// Picture and sound joined.

#include "wisp/capture/capture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

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

// Programs that write images store a dark picture without colours.
TEST_F(Capture, GreyImagesAmongColouredOnesHaveTheSameOutline) {
  const Captured grey = captured({.rate_hz = 50});
  for (int k = 0; k < 40; k += 2) {
    const support::Plane plane = support::flame_picture(support::swaying(k));
    std::filesystem::remove(folder_ / (std::to_string(100 + k) + ".pgm"));
    std::ofstream out(folder_ / (std::to_string(100 + k) + ".ppm"), std::ios::binary);
    out << "P6\n" << plane.width << ' ' << plane.height << "\n255\n";
    for (const std::uint8_t pixel : plane.pixels) out << pixel << pixel << pixel;
  }
  const Captured mixed = captured({.channel = PixelChannel::kBlue, .rate_hz = 50});
  EXPECT_EQ(mixed.recording.channels[9].samples, grey.recording.channels[9].samples);
}

TEST_F(Capture, ARangeMayBeginWithALostFrame) {
  std::filesystem::remove(folder_ / "110.pgm");
  const Captured clip = captured({.frames = FrameRange{11, 40}, .rate_hz = 50});
  ASSERT_EQ(clip.recording.rows(), 30u);
  EXPECT_TRUE(std::isnan(clip.recording.channels.front().samples.front()));
}

TEST_F(Capture, ARangeOfImagesMayEndWithALostFrame) {
  std::filesystem::remove(folder_ / "129.pgm");
  EXPECT_EQ(captured({.frames = FrameRange{1, 30}, .rate_hz = 50}).recording.rows(), 29u);
}

TEST_F(Capture, ARangeBeyondTheEndIsRefusedByBrightnessAndFallsToo) {
  const FrameRange beyond{11, 41};
  EXPECT_THAT(capture_brightness(folder_.path(), {.frames = beyond, .rate_hz = 50}).error().message,
              HasSubstr("found 40 frames, expected frames 11:41"));
  EXPECT_THAT(capture_falls(folder_.path(), {.frames = beyond, .rate_hz = 50}).error().message,
              HasSubstr("found 40 frames, expected frames 11:41"));
}

TEST_F(Capture, BrightnessOfARangeHasTheRowsOfTheRange) {
  const auto light = capture_brightness(folder_.path(), {.frames = FrameRange{11, 40}, .rate_hz = 50});
  ASSERT_TRUE(light) << light.error().message;
  ASSERT_EQ(light->rows(), 30u);
  EXPECT_FALSE(std::isnan(light->channels.front().samples.front()));
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

// Wind from a sound file alone.
TEST(CaptureWind, ASoundFileHasAsManyRowsAsItLasts) {
  const ScratchFolder folder("wind");
  constexpr int kRate = 48000;
  std::vector<std::int16_t> samples(8 * kRate);
  unsigned state = 1;
  double low = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    state = state * 1664525U + 1013904223U;
    const double noise = static_cast<double>(state) / 2147483648.0 - 1;
    low += 0.01 * (noise - low);  // breath at a microphone: most of it below 100 Hz, and hiss
    const bool blown = k > 3 * kRate && k < 5 * kRate;
    samples[k] =
        static_cast<std::int16_t>(32000 * std::clamp(1e-4 * noise + (blown ? 4 * low + 0.05 * noise : 0), -1.0, 1.0));
  }
  support::write_wav(folder / "breath.wav", kRate, 1, samples);
  const auto wind = capture_wind(folder / "breath.wav", 50);
  ASSERT_TRUE(wind) << wind.error().message;
  ASSERT_EQ(wind->rows(), 400u);
  EXPECT_EQ(wind->channels.front().name, "wind");
  EXPECT_EQ(wind->channels.front().role, Role::kInput);
  EXPECT_GT(wind->channels.front().samples[200], 0.2);
  EXPECT_LT(wind->channels.front().samples[100], 1e-3);
  const auto none = capture_wind(folder / "none.wav", 50);
  EXPECT_FALSE(none);
  std::filesystem::resize_file(folder / "breath.wav", std::filesystem::file_size(folder / "breath.wav") / 2 + 1);
  const auto half = capture_wind(folder / "breath.wav", 50);
  ASSERT_FALSE(half);
  EXPECT_NE(half.error().message.find("it was cut off after 4 s"), std::string::npos) << half.error().message;
}

}  // namespace
}  // namespace wisp::capture_test
