// A film that is altered in a known way: what is known of the outline, its facts and the verdict changes as it must, or
// not at all. Films are made by FFmpeg's program from one drawn candle.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <random>

#include "capture/support/clip_files.hpp"
#include "capture/support/overlap.hpp"
#include "model/bspline.hpp"
#include "wisp/capture/capture.hpp"

namespace wisp::metamorphic_test {
namespace {

using testing::HasSubstr;

constexpr int kWidth = 240, kHeight = 200, kFrames = 75;
constexpr double kRate = 25;

/// A swaying flame on a candle of red wax before a dim wall, with a camera's grain.
void draw(const std::filesystem::path& path) {
  std::ofstream out(path, std::ios::binary);
  std::mt19937 random(11);
  for (int k = 0; k < kFrames; ++k) {
    const double t = 0.35 * k;
    const support::Flame flame{.base_x = 120,
                               .base_y = 130,
                               .height = 80 + 6 * std::sin(0.73 * t + 1),
                               .half_width = 13 + 1.2 * std::sin(1.31 * t + 2),
                               .lean = 9 * std::sin(t) + 4 * std::sin(2.3 * t)};
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const double cover = std::clamp(0.5 + flame.depth(x, y) / 3, 0.0, 1.0);
        const bool wax = y > 136 && std::abs(x - 120) < 26;
        const double ground[] = {wax ? 90.0 : 24.0, wax ? 22.0 : 20.0, wax ? 20.0 : 18.0}, light[] = {250, 225, 130};
        for (int c = 0; c < 3; ++c) {
          const double value = ground[c] + cover * (light[c] - ground[c]) + static_cast<int>(random() % 7) - 3;
          out.put(static_cast<char>(static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0))));
        }
      }
    }
  }
}

struct Alteration {
  const char* name;
  const char* filter;
  const char* reason;                                  ///< what the verdict says, or "" where it stays usable
  double turned[6] = {1, 0, 0, 0, 1, 0};               ///< x' and y' from x, y and 1
  double frames = 1;                                   ///< frames for one of before
  std::optional<PixelChannel> channel = std::nullopt;  ///< channel that capture is told to use
};

constexpr const char* kCoded = "-c:v libx264 -crf 16 -pix_fmt yuv420p";

class Metamorphic : public testing::TestWithParam<Alteration> {
 protected:
  static void SetUpTestSuite() {
    if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) return;
    folder_ = new support::ScratchFolder("metamorphic");
    draw(*folder_ / "raw.rgb");
    made("-f rawvideo -pix_fmt rgb24 -s 240x200 -r 25 -i raw.rgb " + std::string(kCoded) + " film.mp4");
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  void SetUp() override {
    if (folder_ == nullptr) GTEST_SKIP() << "no ffmpeg program to make films with";
  }

  static void made(const std::string& how) {
    const std::string command = "cd '" + folder_->path().string() + "' && ffmpeg -v error -y " + how + " 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
  }

  static Captured captured(const std::string& name, const Alteration& how = {}) {
    FlameCapture options;
    options.channel = how.channel;
    auto clip = capture(*folder_ / name, options);
    if (clip) return *std::move(clip);
    Captured none;  // in which no flame was found at all
    none.report.verdict = ReportVerdict{false, clip.error().message};
    return none;
  }

  static support::ScratchFolder* folder_;
};
support::ScratchFolder* Metamorphic::folder_ = nullptr;

std::map<std::string, double> facts_of(const Captured& clip) {
  std::map<std::string, double> out;
  for (const ReportSection& section : clip.report.sections) {
    for (const ReportTable& table : section.tables) {
      if (table.id != "facts") continue;
      for (const auto& row : table.rows) out[std::get<std::string>(row[0])] = std::get<double>(row[1]);
    }
  }
  return out;
}

/// The outline's pixels in a row, its control points moved by `turned`; empty where there is none.
std::optional<support::Mask> mask_of(const Recording& recording, std::size_t row, const double (&turned)[6]) {
  const auto knots = numbers_attribute(recording, "knots");
  std::vector<double> controls;
  for (int k = 0; find_channel(recording, "p" + std::to_string(k) + ".x"); ++k) {
    const double x = recording.channels[2 * static_cast<std::size_t>(k)].samples[row],
                 y = recording.channels[2 * static_cast<std::size_t>(k) + 1].samples[row];
    if (std::isnan(x)) return std::nullopt;
    controls.push_back(turned[0] * x + turned[1] * y + turned[2]);
    controls.push_back(turned[3] * x + turned[4] * y + turned[5]);
  }
  const SplineTable table(knots && *knots ? **knots : uniform_knots(static_cast<int>(controls.size() / 2)));
  return support::curve_mask(table, controls, 2 * kWidth, 2 * kHeight);
}

TEST_P(Metamorphic, ChangesAsItMust) {
  const Alteration& how = GetParam();
  made("-i film.mp4 -vf \"" + std::string(how.filter) + "\" " +
       (std::string(how.name) == "CodedAgain" ? "-c:v mpeg4 -q:v 9 -g 30" : kCoded) + " altered.mp4");
  const Captured before = captured("film.mp4"), after = captured("altered.mp4", how);
  ASSERT_TRUE(before.report.verdict->usable) << before.report.verdict->reason;
  EXPECT_EQ(after.report.verdict->usable, std::string(how.reason).empty()) << after.report.verdict->reason;
  EXPECT_THAT(after.report.verdict->reason, HasSubstr(how.reason));
  if (!after.report.verdict->usable && how.frames == 1) return;

  constexpr double kSame[6] = {1, 0, 0, 0, 1, 0};
  double overlaps = 0, rows = 0;
  for (std::size_t row = 0; row < before.recording.rows(); ++row) {
    const auto at = static_cast<std::size_t>(std::lround(how.frames * static_cast<double>(row)));
    ASSERT_LT(at, after.recording.rows());
    const auto there = mask_of(before.recording, row, how.turned), found = mask_of(after.recording, at, kSame);
    if (!there || !found) continue;
    overlaps += support::overlap(*there, *found);
    ++rows;
  }
  EXPECT_GE(rows, 0.9 * kFrames);
  EXPECT_GE(overlaps / rows, 0.9);
  if (how.frames != 1) return;
  auto facts = facts_of(before), now = facts_of(after);
  for (const char* name : {"movement", "taper", "width"})
    EXPECT_NEAR(now[name], facts[name], 0.2 * facts[name]) << name;
  EXPECT_NEAR(now["lean"], facts["lean"], 3);
  EXPECT_NEAR(now["light"], facts["light"], 0.1);
  for (const char* name : {"lost", "repeated", "missing", "jumps", "border"}) EXPECT_LT(now[name], 0.05) << name;
}

INSTANTIATE_TEST_SUITE_P(
    Films, Metamorphic,
    testing::Values(
        Alteration{"CodedAgain", "null", ""}, Alteration{"Mirrored", "hflip", "", {-1, 0, kWidth - 1, 0, 1, 0}},
        Alteration{"Cropped", "crop=200:180:20:8", "", {1, 0, -20, 0, 1, -8}},
        Alteration{"Brighter", "lutrgb=r=val*1.25:g=val*1.25:b=val*1.25", ""},
        Alteration{"Darker", "lutrgb=r=val*0.6:g=val*0.6:b=val*0.6", ""}, Alteration{"Grey", "hue=s=0", ""},
        Alteration{"Smaller", "scale=120:100:flags=area", "", {0.5, 0, -0.25, 0, 0.5, -0.25}},
        Alteration{"Slow", "setpts=3*PTS,fps=25/3", ""},
        Alteration{"OfTheRedChannel", "null", "", {1, 0, 0, 0, 1, 0}, 1, PixelChannel::kRed},
        Alteration{"OfTheGreenChannel", "null", "", {1, 0, 0, 0, 1, 0}, 1, PixelChannel::kGreen},
        Alteration{
            "EveryFrameTwice", "fps=50,noise=alls=4:allf=t", "every frame stands 2 times", {1, 0, 0, 0, 1, 0}, 2},
        Alteration{"SlowMotion",
                   "setpts=3*PTS,fps=25,noise=alls=3:allf=t",
                   "every frame stands 3 times",
                   {1, 0, 0, 0, 1, 0},
                   3},
        Alteration{"UpsideDown", "vflip", "is upside down"},
        Alteration{"OnItsSide", "transpose=1", "lies on its side"}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace wisp::metamorphic_test
