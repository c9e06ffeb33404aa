// From a clip to a living model, by the program, and every way in which a clip can be bad.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "cli/program.hpp"
#include "wisp/capture/media/video.hpp"
#include "wisp/draw/flame.hpp"
#include "wisp/draw/video_writer.hpp"
#include "wisp/model/file.hpp"
#include "wisp/record/csv.hpp"

namespace wisp::clip_test {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr int kWidth = 160, kHeight = 200, kFrames = 90;
const std::string kFlame = WISP_SOURCE_DIR "/tests/c/models/flame.wisp";

// A drop-shaped flame that sways and stretches, on black; `tapers` towards its tip.
Image flame_frame(int frame, Point base = {80, 180}, double tapers = 0) {
  std::vector<Point> outline;
  const double sway = 0.15 * std::sin(0.9 * frame) + 0.1 * std::sin(0.37 * frame),
               height = 1 + 0.12 * std::sin(0.53 * frame);
  for (int k = 0; k <= 60; ++k) {
    const double t = k / 60.0, side = t < 0.5 ? -1 : 1, up = 1 - std::abs(2 * t - 1);
    const double half_width = 0.16 * std::sqrt(1 - up) * (1 + 0.6 * up) * (1 - tapers * up);
    outline.push_back({static_cast<float>(side * half_width + sway * up * up), static_cast<float>(height * up)});
  }
  Image image(kWidth, kHeight);
  const Flame flame{outline, {.base = base, .pixels_per_unit = 120}};
  draw_flames(image, {&flame, 1}, {.glow = 0, .candle = false});
  return image;
}

class Clip : public InFolder {
 protected:
  void write_clip(const std::string& name, int frames, bool black = false) {
    auto film = VideoWriter::create(at(name), {.width = kWidth, .height = kHeight, .rate_hz = 30});
    ASSERT_TRUE(film) << film.error().message;
    for (int k = 0; k < frames; ++k) ASSERT_TRUE(film->write(black ? Image(kWidth, kHeight) : flame_frame(k)));
    ASSERT_TRUE(film->finish());
  }

  // The command fails with status 1, one line that holds `word`, and no output file.
  void expect_refused(const std::string& arguments, const std::string& word, int status = 1) {
    const Said said = wisp(arguments + " -o " + at("out.csv"));
    EXPECT_EQ(said.status, status) << arguments;
    EXPECT_THAT(said.err, HasSubstr(word)) << arguments;
    EXPECT_EQ(std::count(said.err.begin(), said.err.end(), '\n'), 1) << said.err;
    EXPECT_FALSE(fs::exists(at("out.csv"))) << arguments;
  }
};

TEST_F(Clip, SeveralBecomeRecordingsInAFolder) {
  write_clip("one.mp4", kFrames);
  write_clip("two.mp4", kFrames / 2);
  write_clip("black.mp4", 10, true);
  fs::create_directory(at("more"));
  write_clip("more/one.mp4", 10);
  const std::string good = at("one.mp4") + " " + at("two.mp4");
  const Said said = wisp("capture flame " + good + " -o " + at("recordings") + " --json");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_EQ(said.json()["clips"].size(), 2U);
  ASSERT_EQ(wisp("capture flame " + at("two.mp4") + " -o " + at("alone.csv")).status, 0);
  EXPECT_EQ(file_text(at("recordings/two.csv")), file_text(at("alone.csv")));
  EXPECT_EQ(said.json()["clips"][1]["recording"], at("recordings/two.csv"));
  ASSERT_EQ(wisp("capture flame " + at("more/one.mp4") + " -o " + at("recordings")).status, 0);
  EXPECT_NE(file_text(at("recordings/one.csv")), "");

  const Said skipped =
      wisp("capture flame " + good + " " + at("black.mp4") + " --skip-bad -o " + at("left") + " --json");
  EXPECT_EQ(skipped.status, 0) << skipped.err;
  EXPECT_EQ(skipped.json()["skipped"].size() + skipped.json()["clips"].size(), 3U);
  expect_refused("capture flame " + good, "expected a folder for those of 2 clips", 2);
  const Said same = wisp("capture flame " + at("one.mp4") + " " + at("more/one.mp4") + " -o " + at("two"));
  EXPECT_EQ(same.status, 1);
  EXPECT_THAT(same.err, HasSubstr("would both be written as"));
}

TEST_F(Clip, BecomesARecordingAModelAndPictures) {
  write_clip("clip.mp4", kFrames);
  const Said captured = wisp("capture flame " + at("clip.mp4") + " -o " + at("rec.csv") + " --json");
  ASSERT_EQ(captured.status, 0) << captured.err;
  EXPECT_EQ(captured.json()["frames"], kFrames);
  EXPECT_GE(captured.json()["tracked"].get<int>(), kFrames - 5);
  EXPECT_EQ(captured.json()["points"], 8);
  EXPECT_FALSE(captured.json()["wind"]["heard"]);

  const Said learned = wisp("learn flame " + at("rec.csv") + " -o " + at("m.wisp") + " --json");
  ASSERT_EQ(learned.status, 0) << learned.err;
  // Nobody blows: every component of the shape has the one coefficient by which deviations from recorded rows fade.
  EXPECT_EQ(learned.json()["cost"]["multiply_adds_per_frame"], 2 * 8 - 2);
  EXPECT_LT(learned.json()["stable"]["radius"].get<double>(), 1);

  const Said validated =
      wisp("validate " + at("m.wisp") + " " + at("rec.csv") + " --clip " + at("clip.mp4") + " --overlay " +
           at("overlay.mp4") + " --film-strip " + at("strip.png") + " --figures " + at("figures") + " --json");
  ASSERT_EQ(validated.status, 0) << validated.err;
  EXPECT_TRUE(validated.json()["tip"]["fit_percent"].contains("inf"));
  EXPECT_GT(validated.json()["overlap_by_steps"]["1"].get<double>(), 0.7);
  for (const char* name : {"overlay.mp4", "strip.png", "figures/flicker.svg", "figures/residual-noise.png"}) {
    EXPECT_GT(fs::file_size(at(name)), 1000u) << name;
  }
  write_clip("short.mp4", 30);
  const std::string other =
      "validate " + at("m.wisp") + " " + at("rec.csv") + " --clip " + at("short.mp4") + " --overlay ";
  const Said early = wisp(other + at("early.mp4")), never = wisp(other + at("never.mp4") + " --frames 60:90");
  EXPECT_EQ(early.status, 0) << early.err;
  EXPECT_THAT(early.err, HasSubstr("short.mp4: ends after 30 of the recording's 90 rows"));
  EXPECT_EQ(never.status, 1);
  EXPECT_THAT(never.err, HasSubstr("short.mp4: ends after 0 of the recording's 90 rows"));
  EXPECT_EQ(wisp("run " + at("m.wisp") + " --frames 40 --instances 2 -o " + at("flame.mp4")).status, 0);
  EXPECT_GT(fs::file_size(at("flame.mp4")), 1000u);
}

TEST_F(Clip, AnotherFilmThanTheRecordingsAndAnotherNumberOfPointsAreErrors) {
  write_clip("clip.mp4", kFrames);
  ASSERT_EQ(wisp("capture flame " + at("clip.mp4") + " -o " + at("rec.csv")).status, 0);
  ASSERT_EQ(wisp("learn flame " + at("rec.csv") + " -o " + at("m.wisp")).status, 0);
  auto wide = VideoWriter::create(at("wide.mp4"), {.width = 2 * kWidth, .height = kHeight, .rate_hz = 30});
  ASSERT_TRUE(wide);
  for (int k = 0; k < kFrames; ++k) ASSERT_TRUE(wide->write(Image(2 * kWidth, kHeight)));
  ASSERT_TRUE(wide->finish());
  for (const std::string& picture : {"--overlay " + at("a.mp4"), "--film-strip " + at("a.png")}) {
    const Said said =
        wisp("validate " + at("m.wisp") + " " + at("rec.csv") + " --clip " + at("wide.mp4") + " " + picture);
    EXPECT_EQ(said.status, 1) << picture;
    EXPECT_THAT(said.err, HasSubstr("wide.mp4: its pictures are 320 × 200 pixels, expected 160 × 200")) << picture;
  }
  const Said points =
      wisp("learn flame " + at("rec.csv") + " " + at("clip.mp4") + " --points 16 -o " + at("sixteen.wisp"));
  EXPECT_EQ(points.status, 2);
  EXPECT_THAT(points.err, HasSubstr("--points 16: " + at("rec.csv") + " has 8 control points"));
  EXPECT_FALSE(fs::exists(at("a.mp4")) || fs::exists(at("a.png")) || fs::exists(at("sixteen.wisp")));
}

TEST_F(Clip, AMissingFilmIsNamedBeforeTheOthersAreCaptured) {
  write_clip("clip.mp4", 10);
  for (const std::string command : {"learn flame ", "capture flame "}) {
    const Said said = wisp(command + at("clip.mp4") + " " + at("none.mp4") + " -o " + at("made"));
    EXPECT_EQ(said.status, 1);
    EXPECT_EQ(said.err, "wisp: " + at("none.mp4") + ": no such file; check the path\n");
    EXPECT_EQ(said.out, "");
    EXPECT_TRUE(!fs::exists(at("made")) || fs::is_empty(at("made")));
  }
}

TEST_F(Clip, AFilmStripShowsTheLearnedFlameInTheClipsOwnLightAndCrop) {
  auto film = VideoWriter::create(at("clip.mp4"), {.width = kWidth, .height = kHeight, .rate_hz = 30});
  ASSERT_TRUE(film);
  for (int k = 0; k < kFrames; ++k) ASSERT_TRUE(film->write(flame_frame(k, {80, 155}, 0.4)));
  ASSERT_TRUE(film->finish());
  fs::create_directories(at("strips"));
  ASSERT_EQ(wisp("learn flame " + at("clip.mp4") + " -o " + at("m.wisp")).status, 0);
  ASSERT_EQ(wisp("validate " + at("m.wisp") + " " + at("clip.mp4") + " --film-strip " + at("strips/1.png")).status, 0);
  auto reader = VideoReader::open(at("strips"), {.rate_hz = 1});
  ASSERT_TRUE(reader) << reader.error().message;
  ASSERT_TRUE(*reader->next());
  const RgbImage rgb = reader->rgb();
  const Image strip = Image::from_rgb(rgb.pixels, rgb.width, rgb.height);
  // What stands under the flame is the clip's, and not a candle of the program's own: the feet of both rows are alike.
  constexpr int kFoot = 250, kHigh = 10, kRowsApart = 251;
  double difference = 0;
  for (int y = kFoot; y < kFoot + kHigh; ++y) {
    for (int x = 0; x < strip.width(); ++x) {
      const Colour above = strip.at(x, y), below = strip.at(x, y + kRowsApart);
      difference +=
          std::abs(above.red - below.red) + std::abs(above.green - below.green) + std::abs(above.blue - below.blue);
    }
  }
  EXPECT_LT(difference / (3.0 * kHigh * strip.width()), 6);
}

TEST_F(Clip, AFlameIsDrawnOnTheCandleOfItsFilm) {
  constexpr std::uint32_t kWax = 0xFF208040U;  // greener than any that Wisp would draw
  fs::create_directories(at("frames"));
  auto film = VideoWriter::create(at("clip.mp4"), {.width = kWidth, .height = kHeight, .rate_hz = 30});
  ASSERT_TRUE(film);
  for (int k = 0; k < kFrames; ++k) {
    Image image = flame_frame(k, {80, 155}, 0.4);
    for (int y = 160; y < kHeight; ++y) std::ranges::fill(image.row(y).subspan(60, 40), kWax);
    ASSERT_TRUE(film->write(image));
    ASSERT_TRUE(write_png(at("frames/" + std::to_string(k) + ".png"), image));
  }
  ASSERT_TRUE(film->finish());
  ASSERT_EQ(wisp("capture flame " + at("clip.mp4") + " --frames 11:90 -o " + at("rec.csv")).status, 0);
  EXPECT_THAT(file_text(at("rec.csv")), HasSubstr("# first_frame 11"));
  ASSERT_EQ(wisp("learn flame " + at("rec.csv") + " -o " + at("m.wisp")).status, 0);
  const std::string run = "run " + at("m.wisp") + " --frames 40";
  fs::create_directories(at("pictures"));
  for (const char* name : {"rec.csv", "clip.mp4", "frames"}) {
    const Said said = wisp(run + " --clip " + at(name) + " -o " + at("pictures/1.png"));
    ASSERT_EQ(said.status, 0) << said.err;
    auto reader = VideoReader::open(at("pictures"), {.rate_hz = 1});
    ASSERT_TRUE(reader);
    ASSERT_TRUE(reader->next());
    const RgbImage picture = reader->rgb();
    EXPECT_EQ(picture.height, 720);
    const auto at_pixel = [&](double across, double down) {
      const auto x = static_cast<std::size_t>(across * picture.width),
                 y = static_cast<std::size_t>(down * picture.height);
      return &picture.pixels[3 * (y * static_cast<std::size_t>(picture.width) + x)];
    };
    const std::uint8_t* wax = at_pixel(0.5, 0.95);
    EXPECT_NEAR(wax[0], 0x20, 12);
    EXPECT_NEAR(wax[1], 0x80, 12);
    EXPECT_NEAR(wax[2], 0x40, 12);
    EXPECT_GT(at_pixel(0.5, 0.6)[0], 180);
    EXPECT_LT(at_pixel(0.02, 0.1)[0], 20);
  }
  // Frames of the part are beside their own rows without being told of it again.
  const std::string strip =
      "validate " + at("m.wisp") + " " + at("rec.csv") + " --clip " + at("clip.mp4") + " --film-strip ";
  ASSERT_EQ(wisp(strip + at("a.png")).status, 0);
  ASSERT_EQ(wisp(strip + at("b.png") + " --frames 11:90").status, 0);
  EXPECT_EQ(file_text(at("a.png")), file_text(at("b.png")));
  for (const char* flags : {" -o out.csv", " --instances 2 -o out.png", " --camera 20 -o out.png"}) {
    const Said said = wisp(run + " --clip " + at("rec.csv") + flags);
    EXPECT_EQ(said.status, 2) << flags;
  }
}

TEST_F(Clip, AFilmThatARecordingNamesIsNotOverwritten) {
  write_clip("film.mp4", kFrames);
  fs::create_directories(at("frames"));
  for (int k = 0; k < kFrames; ++k)
    ASSERT_TRUE(write_png(at("frames/" + std::to_string(100 + k) + ".png"), flame_frame(k)));
  ASSERT_EQ(wisp("capture flame " + at("film.mp4") + " -o " + at("film.csv")).status, 0);
  ASSERT_EQ(wisp("capture flame --rate 30 " + at("frames") + " -o " + at("frames.csv")).status, 0);
  for (const auto& [recording, named] : {std::pair{"film.csv", "film.mp4"}, {"frames.csv", "frames/100.png"}}) {
    const std::string before = file_text(at(named));
    const Said said = wisp("run " + kFlame + " --frames 2 --clip " + at(recording) + " -o " + at(named));
    EXPECT_EQ(said.status, 2) << said.err;
    EXPECT_THAT(said.err, HasSubstr("is a file that is read, and would be lost: give another name"));
    EXPECT_TRUE(file_text(at(named)) == before) << named;
  }
}

TEST_F(Clip, AFlameThatIsLitAfterAMinuteShowsItsCandle) {
  constexpr int kBefore = 1900;
  write_clip("short.mp4", kFrames);
  ASSERT_EQ(wisp("capture flame " + at("short.mp4") + " -o " + at("short.csv")).status, 0);
  auto film = VideoWriter::create(at("long.mp4"), {.width = kWidth, .height = kHeight, .rate_hz = 30});
  ASSERT_TRUE(film) << film.error().message;
  for (int k = 0; k < kBefore; ++k) ASSERT_TRUE(film->write(Image(kWidth, kHeight)));
  for (int k = 0; k < kFrames; ++k) ASSERT_TRUE(film->write(flame_frame(k)));
  ASSERT_TRUE(film->finish());
  auto recording = read_csv(at("short.csv"));
  ASSERT_TRUE(recording) << recording.error().message;
  for (Channel& channel : recording->channels)
    channel.samples.insert(channel.samples.begin(), kBefore, std::numeric_limits<double>::quiet_NaN());
  for (RowFlag& flag : recording->flags) flag.rows.insert(flag.rows.begin(), kBefore, 0);
  if (!recording->episode_ids.empty()) {
    const auto first = recording->episode_ids.front();
    recording->episode_ids.insert(recording->episode_ids.begin(), kBefore, first);
  }
  for (Attribute& attribute : recording->attributes) {
    if (attribute.name == "source") attribute.value = at("long.mp4");
  }
  ASSERT_TRUE(write_csv(at("long.csv"), *recording));
  const Said said = wisp("run " + kFlame + " --frames 2 --clip " + at("long.csv") + " -o " + at("flame.png"));
  EXPECT_EQ(said.status, 0) << said.err;
}

TEST_F(Clip, TheSameSeedGivesTheSameBytes) {
  write_clip("clip.mp4", kFrames);
  ASSERT_EQ(wisp("learn flame " + at("clip.mp4") + " -o " + at("a.wisp")).status, 0);
  ASSERT_EQ(wisp("learn flame " + at("clip.mp4") + " -o " + at("b.wisp")).status, 0);
  for (const char* name : {"a", "b"}) {
    ASSERT_EQ(
        wisp("run " + at(std::string(name) + ".wisp") + " --frames 200 --seed 5 -o " + at(std::string(name) + ".csv"))
            .status,
        0);
  }
  EXPECT_EQ(file_text(at("a.csv")).substr(100), file_text(at("b.csv")).substr(100));
}

TEST_F(Clip, ThatCannotBeUsedIsRefusedWithOneLineAndNoOutput) {
  expect_refused("capture flame " + at("nowhere.mp4"), "nowhere.mp4");
  std::ofstream(at("text.mp4")) << "This is not a film.\n";
  expect_refused("capture flame " + at("text.mp4"), "text.mp4");
  write_clip("black.mp4", 40, true);
  expect_refused("capture flame " + at("black.mp4"), "black.mp4");
  write_clip("short.mp4", 3);
  expect_refused("capture flame " + at("short.mp4"), "short.mp4");
  write_clip("clip.mp4", 40);
  expect_refused("capture flame " + at("clip.mp4") + " --region 100,100,500,500", "region");
  expect_refused("capture flame " + at("clip.mp4") + " --region here", "--region", 2);
  expect_refused("capture flame " + at("clip.mp4") + " --points 3", "--points", 2);
  expect_refused("capture flame " + at("clip.mp4") + " --frames 30:400", "30:400");
  fs::create_directories(at("empty"));
  expect_refused("capture flame --rate 30 " + at("empty"), "empty");
}

TEST_F(Clip, AFolderWithOneImageOfAnotherSizeNamesIt) {
  fs::create_directories(at("frames"));
  for (int k = 0; k < 20; ++k) {
    const std::string name = at("frames/" + std::to_string(100 + k) + ".png");
    ASSERT_TRUE(write_png(name, k == 13 ? resized(flame_frame(k), 100, 100) : flame_frame(k)));
  }
  expect_refused("capture flame --rate 30 " + at("frames"), "113.png");
  fs::remove(at("frames/113.png"));
  EXPECT_EQ(wisp("capture flame --rate 30 " + at("frames") + " -o " + at("ok.csv")).status, 0);
}

TEST_F(Clip, TheLightOfImagesTakesAnyFlagOfTheirRateOrRefusesIt) {
  fs::create_directories(at("frames"));
  for (int k = 0; k < 5; ++k) ASSERT_TRUE(write_png(at("frames/" + std::to_string(k) + ".png"), flame_frame(k)));
  const std::string light = "capture brightness " + at("frames");
  ASSERT_EQ(wisp(light + " --dt 0.05 -o " + at("light.csv")).status, 0);
  const auto recording = read_csv(at("light.csv"));
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_NEAR(recording->rate_hz, 20, 1e-9);
  expect_refused(light + " --rate -4", "--rate: found \"-4\", expected frames a second above 0", 2);
  expect_refused(light + " --rate 1e12", "--rate: 1e+12 samples a second", 2);
  expect_refused(light + " --rate 30 --columns a,b", "--columns is of a table", 2);
  expect_refused("capture fall " + at("frames") + " --rate 0", "--rate: found \"0\"", 2);
}

TEST_F(Clip, CutInHalfIsUsedAsFarAsItGoesOrRefused) {
  write_clip("whole.mp4", kFrames);
  const std::string bytes = file_text(at("whole.mp4"));
  std::ofstream(at("half.mp4"), std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  const Said said = wisp("capture flame " + at("half.mp4") + " -o " + at("half.csv"));
  EXPECT_NE(said.err, "");
  EXPECT_EQ(said.status == 0, fs::exists(at("half.csv")));
}

TEST_F(Clip, ARecordingOfOtherPointsThanTheModelIsExplained) {
  write_clip("clip.mp4", kFrames);
  ASSERT_EQ(wisp("capture flame " + at("clip.mp4") + " -o " + at("eight.csv")).status, 0);
  ASSERT_EQ(wisp("capture flame " + at("clip.mp4") + " --points 12 -o " + at("twelve.csv")).status, 0);
  ASSERT_EQ(wisp("learn flame " + at("eight.csv") + " -o " + at("m.wisp")).status, 0);
  const Said said = wisp("validate " + at("m.wisp") + " " + at("twelve.csv"));
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.err, HasSubstr("--points 8"));
}

TEST_F(Clip, TheDemoLeavesItsResultsInAFolder) {
  write_clip("clip.mp4", kFrames);
  const Said said = wisp("demo " + at("clip.mp4") + " -o " + at("demo"));
  ASSERT_EQ(said.status, 0) << said.err;
  for (const char* name :
       {"recording.csv", "flame.wisp", "overlay.mp4", "film-strip.png", "flame.mp4", "summary.json"}) {
    EXPECT_TRUE(fs::exists(fs::path(at("demo")) / name)) << name;
  }
  EXPECT_THAT(said.out, HasSubstr("What to try next"));
}

TEST_F(Clip, ADemoOfAClipThatIsRefusedLeavesNoFolderThatItMade) {
  write_clip("short.mp4", 4);
  fs::create_directory(at("mine"));
  EXPECT_EQ(wisp("demo " + at("short.mp4") + " -o " + at("mine/out/demo")).status, 1);
  EXPECT_TRUE(fs::exists(at("mine")));
  EXPECT_FALSE(fs::exists(at("mine/out")));
}

}  // namespace
}  // namespace wisp::clip_test
