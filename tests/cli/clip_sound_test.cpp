// A clip's sound as phones and cameras leave it: learning from it works, or says in one clause what is missing.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "cli/program.hpp"
#include "record/loudness.hpp"
#include "wisp/draw/image.hpp"
#include "wisp/draw/video_writer.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::clip_sound_test {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr int kWidth = 160, kHeight = 200, kFrames = 600;
constexpr double kRate = 30, kSeconds = kFrames / kRate;

// Gusts of different strength and length, with rests.
double wind_at(double seconds) {
  const double beat = 1.7 * seconds + 0.9 * std::sin(0.6 * seconds);
  const double gust = std::sin(std::numbers::pi * beat);
  return gust > 0 && std::fmod(beat, 4) < 3 ? gust * (0.6 + 0.4 * std::sin(2.3 * seconds)) : 0;
}

// A drop-shaped flame that leans with the wind of a twentieth of a second ago and trembles a little. Its edge is sharp,
// as an overexposed flame's is: what is asked here is when it moves, not where its light ends.
Image flame_frame(int frame) {
  static std::mt19937 random(3);
  std::normal_distribution<double> tremble(0, 0.01);
  const double lean = 0.5 * wind_at(frame / kRate - 0.05) + tremble(random);
  constexpr double kBaseX = 60, kBaseY = 180, kUnit = 120;
  std::vector<std::uint8_t> rgb(3 * static_cast<std::size_t>(kWidth) * kHeight);
  for (int y = 0; y < kHeight; ++y) {
    const double up = (kBaseY - y - 0.5) / kUnit;
    if (up < 0 || up > 1) continue;
    const double half_width = kUnit * 0.16 * std::sqrt(1 - up) * (0.6 + 1.4 * up),
                 middle = kBaseX + kUnit * lean * up * up;
    for (int x = 0; x < kWidth; ++x) {
      const double covered = std::clamp(half_width - std::abs(x + 0.5 - middle) + 0.5, 0.0, 1.0);
      const auto level = static_cast<std::uint8_t>(std::lround(250 * covered));
      std::fill_n(rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * kWidth + x), 3, level);
    }
  }
  return Image::from_rgb(rgb, kWidth, kHeight);
}

// How the wind sounds.
struct Microphone {
  int rate_hz = 44100;
  double gain = 0.3;
  double hiss = 1e-4;
  double seconds = kSeconds;
};

// Noise below about 300 Hz whose amplitude goes with the square of the wind's speed.
std::vector<float> heard_by(const Microphone& microphone) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  const double share = 1 - std::exp(-2 * std::numbers::pi * 300 / microphone.rate_hz);
  const double level = microphone.gain / std::sqrt(share / 2);
  std::vector<float> out;
  double low = 0;
  for (int k = 0; k < microphone.seconds * microphone.rate_hz; ++k) {
    const double wind = wind_at(k / static_cast<double>(microphone.rate_hz));
    low += share * (normal(random) - low);
    out.push_back(static_cast<float>(level * wind * wind * low + microphone.hiss * normal(random)));
  }
  return out;
}

class ClipSound : public testing::Test {
 protected:
  void SetUp() override {
    // By process, so that two runs at once do not meet.
    folder_ = fs::path(testing::TempDir()) / ("wisp-clip-sound-" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write_clip(const std::string& name, const Microphone& microphone) {
    auto film = VideoWriter::create(
        at(name), {.width = kWidth, .height = kHeight, .rate_hz = kRate, .sound_rate_hz = microphone.rate_hz});
    ASSERT_TRUE(film) << film.error().message;
    for (int k = 0; k < kFrames; ++k) ASSERT_TRUE(film->write(flame_frame(k)));
    if (microphone.rate_hz > 0) {
      ASSERT_TRUE(film->write_sound(heard_by(microphone)));
    }
    ASSERT_TRUE(film->finish());
  }

  // What learning from the clip says; it must succeed.
  nlohmann::json learned(const std::string& name, const std::string& flags = "") {
    const Said said = wisp("learn flame " + at(name) + " -o " + at("m.wisp") + " --json " + flags);
    EXPECT_EQ(said.status, 0) << said.err;
    return said.status == 0 ? said.json() : nlohmann::json();
  }

  // From its sound alone the flame is followed.
  void expect_followed(const nlohmann::json& learning) {
    ASSERT_EQ(learning["inputs"].size(), 1u);
    EXPECT_EQ(learning["inputs"][0]["name"], "wind");
    EXPECT_GT(learning["tip"]["held_out_fit_percent"]["inf"].get<double>(), 40);
    const nlohmann::json& alignment = learning["alignment"][0];
    EXPECT_TRUE(alignment["usable"].get<bool>()) << alignment["reason"];
    EXPECT_NEAR(alignment["offset_seconds"].get<double>(), 0.05, 0.05);
  }

  Said wisp(const std::string& arguments) { return run_wisp(arguments, folder_); }
  std::string at(const std::string& name) const { return (folder_ / name).string(); }
  fs::path folder_;
};

TEST_F(ClipSound, IsHeardAndInStepAtEveryRate) {
  for (const int rate_hz : {8000, 44100, 96000}) {
    write_clip("clip.mp4", {.rate_hz = rate_hz});
    SCOPED_TRACE(rate_hz);
    expect_followed(learned("clip.mp4"));
  }
}

// Wind 1 is whatever blew hard in a clip. How loud that was goes with the recording, so that clips can be held
// together.
TEST_F(ClipSound, SaysHowLoudItWasAtWindOne) {
  write_clip("clip.mp4", {});
  write_clip("softer.mp4", {.gain = 0.075});
  for (const char* name : {"clip", "softer"}) {
    const Said said = wisp("capture flame " + at(name) + ".mp4 -o " + at(name) + ".csv");
    ASSERT_EQ(said.status, 0) << said.err;
  }
  const auto clip = one_rms(*read_csv(at("clip.csv")), "wind"), softer = one_rms(*read_csv(at("softer.csv")), "wind");
  ASSERT_TRUE(clip && *clip && softer && *softer);
  EXPECT_NEAR(**clip / **softer, 4, 0.2);
}

TEST_F(ClipSound, ThatIsClippedIsUsedWithAWarning) {
  write_clip("clip.mp4", {.gain = 6});
  const nlohmann::json learning = learned("clip.mp4");
  EXPECT_THAT(learning["warnings"].dump(), HasSubstr("clipped"));
  ASSERT_EQ(learning["inputs"].size(), 1u);
  EXPECT_GT(learning["tip"]["held_out_fit_percent"]["inf"].get<double>(), 20);
}

TEST_F(ClipSound, ThatEndsBeforeThePictureIsUsedAsFarAsItGoes) {
  write_clip("clip.mp4", {.seconds = 14});
  const nlohmann::json learning = learned("clip.mp4");
  EXPECT_THAT(learning["warnings"].dump(), HasSubstr("frames before the picture"));
  expect_followed(learning);
  const int used = learning["samples"]["learned"].get<int>() + learning["samples"]["held_out"].get<int>();
  EXPECT_NEAR(used, 14 * kRate, 15);
}

TEST_F(ClipSound, ThatIsMissingLeavesAFlickerAndSaysSo) {
  write_clip("clip.mp4", {.rate_hz = 0});
  const Said captured = wisp("capture flame " + at("clip.mp4") + " -o " + at("rec.csv") + " --json");
  ASSERT_EQ(captured.status, 0) << captured.err;
  EXPECT_FALSE(captured.json()["wind"]["heard"].get<bool>());
  EXPECT_THAT(captured.json()["wind"]["reason"].get<std::string>(), HasSubstr("no sound track"));
  const nlohmann::json learning = learned("clip.mp4");
  EXPECT_EQ(learning["inputs"].size(), 0u);
  EXPECT_THAT(learning["warnings"].dump(), HasSubstr("no sound track"));
}

TEST_F(ClipSound, ThatIsSilentLeavesAFlickerAndSaysSo) {
  write_clip("clip.mp4", {.gain = 0, .hiss = 0});
  const nlohmann::json learning = learned("clip.mp4");
  EXPECT_EQ(learning["inputs"].size(), 0u);
  EXPECT_THAT(learning["warnings"].dump(), HasSubstr("silent"));
}

// A wind-driven model needs wind: a clip without any is refused in one line.
TEST_F(ClipSound, AModelOfWindIsNotHeldAgainstAClipWithout) {
  write_clip("windy.mp4", {});
  write_clip("mute.mp4", {.rate_hz = 0});
  learned("windy.mp4");
  const Said said = wisp("validate " + at("m.wisp") + " " + at("mute.mp4"));
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("has no input wind, which tells what blew the flame out"));
}

TEST_F(ClipSound, ACameraThatDropsFramesStaysInStep) {
  if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no ffmpeg program to drop frames with";
  write_clip("clip.mp4", {});
  const std::string drop = "ffmpeg -v error -y -i " + at("clip.mp4") +
                           " -vf \"select='not(eq(mod(n\\,7)\\,3))'\" -fps_mode vfr -preset ultrafast -c:a copy " +
                           at("uneven.mp4");
  ASSERT_EQ(std::system(drop.c_str()), 0);
  const Said captured = wisp("capture flame " + at("uneven.mp4") + " -o " + at("rec.csv") + " --json");
  ASSERT_EQ(captured.status, 0) << captured.err;
  EXPECT_NEAR(captured.json()["rate_hz"].get<double>(), kRate, 0.01);
  EXPECT_NEAR(captured.json()["frames"].get<int>(), kFrames, 3);
  expect_followed(learned("uneven.mp4"));
}

TEST_F(ClipSound, EveryMeasureHasANameOfItsOwn) {
  write_clip("clip.mp4", {});
  for (const auto& [measure, name] : {std::pair{"speed", "wind"}, {"heard", "wind.heard"}, {"rms", "wind.rms"}}) {
    const nlohmann::json learning = learned("clip.mp4", std::string("--wind-measure ") + measure);
    ASSERT_EQ(learning["inputs"].size(), 1u);
    EXPECT_EQ(learning["inputs"][0]["name"], name);
  }
  // The last model is of plain RMS: speed does not drive it.
  const Said said = wisp("validate " + at("m.wisp") + " " + at("clip.mp4"));
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("has no input wind.rms, which tells what blew the flame out"));
  EXPECT_EQ(wisp("validate " + at("m.wisp") + " " + at("clip.mp4") + " --wind-measure rms").status, 0);
}

TEST_F(ClipSound, FiguresShowTheLoudnessOfTheFramesThatAreValidated) {
  write_clip("clip.mp4", {});
  learned("clip.mp4");
  for (const char* frames : {"1:300", "301:600"}) {
    const Said said =
        wisp("validate " + at("m.wisp") + " " + at("clip.mp4") + " --frames " + frames + " --figures " + at(frames));
    ASSERT_EQ(said.status, 0) << said.err;
  }
  EXPECT_TRUE(file_text(at("1:300/sound.svg")) != file_text(at("301:600/sound.svg")));
}

// The 99.9th percentile of ten seconds is of half a frame.
TEST_F(ClipSound, WhatAClipIsTooShortToTellIsSaid) {
  write_clip("clip.mp4", {});
  learned("clip.mp4", "");
  const Said said = wisp("validate " + at("m.wisp") + " " + at("clip.mp4"));
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_THAT(said.out, HasSubstr("violence of the rarest motion"));
  EXPECT_THAT(said.out, HasSubstr("two halves of the recording: too short to tell"));
  EXPECT_THAT(said.out, Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace wisp::clip_sound_test
