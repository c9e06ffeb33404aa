// Films whose times, rates, pixels and headers are not what a counter of frames would think, made by FFmpeg's program.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <random>

#include "capture/support/capture_outline.hpp"
#include "capture/support/clip_files.hpp"
#include "capture/support/made_clip.hpp"
#include "wisp/capture/capture.hpp"
#include "wisp/capture/media/video.hpp"

namespace wisp::film_times_test {
namespace {

using support::Plane;
using support::RawVideo;
using support::ScratchFolder;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr int kFrames = 100;
constexpr int kRate = 25;

class FilmTimes : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no ffmpeg program to make films with";
  }

  // A swaying flame; `bright` is the frame in which the whole picture is lit, if any.
  void film(const std::string& name, int bright = -1) {
    RawVideo video(folder_ / name, 160, 180, kRate);
    for (int k = 0; k < kFrames; ++k) {
      video.add(k == bright ? Plane(160, 180, 235) : support::noisy_flame(k));
    }
  }

  // Quiet, with a puff of loud noise.
  void sound(const std::string& name, double puff_begin, double puff_end, double seconds = 4) {
    std::mt19937 random(5);
    std::vector<std::int16_t> samples(static_cast<std::size_t>(seconds * 16000));
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const double at = static_cast<double>(k) / 16000;
      const int loud = at >= puff_begin && at < puff_end ? 12000 : 60;
      samples[k] = static_cast<std::int16_t>(static_cast<int>(random() % static_cast<unsigned>(2 * loud)) - loud);
    }
    support::write_wav(folder_ / name, 16000, 1, samples);
  }

  // The last word of `how` is the film's name.
  void made(const std::string& how) {
    const std::string command = "cd '" + folder_.path().string() + "' && ffmpeg -v error -y " + how + " 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
  }

  Captured captured(const std::string& name, double rate_hz = 0) {
    FlameCapture options;
    options.rate_hz = rate_hz;
    options.wind = WindMeasure::kRms;
    auto clip = capture(folder_ / name, options);
    EXPECT_TRUE(clip) << (clip ? "" : clip.error().message);
    return *std::move(clip);
  }

  ScratchFolder folder_{"times"};
};

std::vector<double> samples_of(const Captured& clip, const std::string& name) {
  return clip.recording.channels[*find_channel(clip.recording, name)].samples;
}

// The first row of the puff.
std::size_t first_wind(const Captured& clip) {
  const auto wind = samples_of(clip, "wind.rms");
  return static_cast<std::size_t>(std::find_if(wind.begin(), wind.end(), [](double x) { return x > 0.1; }) -
                                  wind.begin());
}

std::vector<std::int64_t> places(VideoReader& reader) {
  std::vector<std::int64_t> out;
  while (true) {
    auto frame = reader.next();
    if (!frame || !frame->has_value()) return out;
    out.push_back((*frame)->index);
  }
}

TEST_F(FilmTimes, AHoleInTheSoundKeepsItsTime) {
  film("flame.y4m");
  sound("puff.wav", 3, 3.6);
  made("-i flame.y4m -i puff.wav -af \"aselect='not(between(t,1,2))'\" -c:a aac -pix_fmt yuv420p gap.mp4");
  const Captured clip = captured("gap.mp4");
  EXPECT_NEAR(static_cast<double>(first_wind(clip)), 75, 2);
  const auto wind = samples_of(clip, "wind.rms");
  EXPECT_TRUE(std::isnan(wind[37]));
  EXPECT_FALSE(std::isnan(wind[20]));
  EXPECT_FALSE(std::isnan(wind[60]));
  EXPECT_THAT(clip.report.warnings, Contains(HasSubstr("in holes; the wind there is missing")));
}

TEST_F(FilmTimes, ARangeMayEndWithALostFrame) {
  film("flame.y4m");
  made("-i flame.y4m -vf \"select='not(eq(n,59))'\" -vsync passthrough -pix_fmt yuv420p gap.mp4");
  FlameCapture options;
  options.frames = FrameRange{1, 60};
  const auto clip = capture(folder_ / "gap.mp4", options);
  ASSERT_TRUE(clip) << clip.error().message;
  EXPECT_EQ(clip->recording.rows(), 59u);
}

TEST_F(FilmTimes, ARangeThatEndsAtAHoleHasNoHole) {
  film("flame.y4m");
  made("-i flame.y4m -vf \"setpts='PTS+gte(N,60)*5/TB'\" -vsync passthrough -pix_fmt yuv420p hole.mkv");
  for (const auto& [last, holes] : {std::pair{60, 0}, {150, 1}}) {
    auto reader = VideoReader::open(folder_ / "hole.mkv", {.frames = FrameRange{1, last}});
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_GE(places(*reader).size(), 60u);
    EXPECT_EQ(reader->times().shortened, holes) << last;
  }
}

// 5 s, of which the grid keeps 2: the puff at 8.2 s is at frame 80, which is the grid's 130.
TEST_F(FilmTimes, ARangeAfterAHoleHasNoHoleAndItsOwnSound) {
  film("flame.y4m");
  sound("puff.wav", 8.2, 8.8, 10);
  made(
      "-i flame.y4m -i puff.wav -vf \"setpts='PTS+gte(N,60)*5/TB'\" -vsync passthrough -c:a pcm_s16le "
      "-pix_fmt yuv420p hole.mkv");
  FlameCapture options;
  options.frames = FrameRange{111, 150};
  options.wind = WindMeasure::kRms;
  const auto clip = capture(folder_ / "hole.mkv", options);
  ASSERT_TRUE(clip) << clip.error().message;
  EXPECT_THAT(clip->report.verdict->reason, Not(HasSubstr("holes")));
  EXPECT_NEAR(static_cast<double>(first_wind(*clip)), 20, 2);
}

TEST_F(FilmTimes, PartsThatAreJoinedByCatFollowOneAnotherWithTheirSound) {
  film("flame.y4m");
  sound("puff.wav", 3, 3.6);
  made("-i flame.y4m -i puff.wav -c:a aac -pix_fmt yuv420p one.ts && cat one.ts one.ts >two.ts");
  const Captured clip = captured("two.ts");
  EXPECT_NEAR(static_cast<double>(clip.recording.rows()), 2 * kFrames, 3);
  EXPECT_TRUE(clip.report.verdict->usable) << clip.report.verdict->reason;
  const auto wind = samples_of(clip, "wind.rms");
  EXPECT_NEAR(static_cast<double>(first_wind(clip)), 75, 2);
  const auto again = std::find_if(wind.begin() + kFrames + 20, wind.end(), [](double x) { return x > 0.1; });
  EXPECT_NEAR(static_cast<double>(again - wind.begin()), kFrames + 75, 4);
}

TEST_F(FilmTimes, SoundThatGoesOnAtAnotherRateIsMissing) {
  film("flame.y4m");
  sound("puff.wav", 3, 3.6);
  made(
      "-i flame.y4m -i puff.wav -c:a aac one.ts && ffmpeg -v error -i flame.y4m -i puff.wav -c:a aac -ar 48000 "
      "other.ts && cat one.ts other.ts >two.ts");
  const Captured clip = captured("two.ts");
  EXPECT_NEAR(static_cast<double>(first_wind(clip)), 75, 2);
  EXPECT_TRUE(std::isnan(samples_of(clip, "wind.rms")[kFrames + 50]));
  EXPECT_THAT(clip.report.warnings, Contains(HasSubstr("the sound ends")));
}

TEST_F(FilmTimes, AnotherRateLeavesThePlacesOfLostFramesEmpty) {
  film("flame.y4m");
  made("-i flame.y4m -vf \"select='not(between(n,40,44))'\" -vsync passthrough -pix_fmt yuv420p gap.mkv");
  auto reader = VideoReader::open(folder_ / "gap.mkv", {.rate_hz = 2.0 * kRate, .frames = {}});
  ASSERT_TRUE(reader) << reader.error().message;
  const auto rows = places(*reader);
  EXPECT_EQ(rows[39], 39);
  EXPECT_EQ(rows[40], 45);
}

TEST_F(FilmTimes, TheBrightnessOfAFilmThatIsCutOffHasAWarning) {
  film("flame.y4m");
  made("-i flame.y4m -c:v mjpeg -pix_fmt yuvj420p film.avi");
  std::filesystem::resize_file(folder_ / "film.avi", std::filesystem::file_size(folder_ / "film.avi") / 2);
  std::vector<std::string> warnings;
  EXPECT_TRUE(capture_brightness(folder_ / "film.avi", {}, {}, &warnings));
  EXPECT_THAT(warnings, Contains(HasSubstr("cut off")));
}

TEST_F(FilmTimes, SoundThatCannotBeDecodedIsToldFromThePicture) {
  film("flame.y4m");
  sound("puff.wav", 1, 2);
  made("-i flame.y4m -i puff.wav -c:a pcm_s16le -pix_fmt yuv420p film.mov");
  std::fstream file(folder_ / "film.mov", std::ios::in | std::ios::out | std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  file.seekp(static_cast<std::streamoff>(bytes.rfind("sowt")));
  file << "zzzz";
  file.close();
  EXPECT_THAT(capture(folder_ / "film.mov", FlameCapture()).error().message,
              HasSubstr("its sound is coded as none, which this FFmpeg cannot decode; convert the sound to AAC"));
}

TEST_F(FilmTimes, TheCoverOfASongIsNoFilm) {
  film("flame.y4m");
  sound("puff.wav", 1, 2);
  made(
      "-i puff.wav -i flame.y4m -map 0 -map 1 -frames:v 1 -c:a aac -c:v png -pix_fmt gray -disposition:v attached_pic "
      "song.m4a");
  EXPECT_THAT(capture(folder_ / "song.m4a", FlameCapture()).error().message, HasSubstr("found no video track"));
  EXPECT_TRUE(hear_wind(folder_ / "song.m4a", kRate));
}

TEST_F(FilmTimes, AFilmMostlyWithoutItsSoundIsNotUsable) {
  film("flame.y4m");
  sound("puff.wav", 0.3, 0.6, 1);
  made("-i flame.y4m -i puff.wav -c:a aac -pix_fmt yuv420p short.mp4");
  const Captured clip = captured("short.mp4");
  EXPECT_FALSE(clip.report.verdict->usable);
  EXPECT_THAT(clip.report.verdict->reason, HasSubstr("its sound is missing for 7"));
}

std::optional<FrameRange> advised(const std::string& reason) {
  FrameRange range;
  const std::size_t at = reason.find("--frames ");
  if (at == std::string::npos) return {};
  const int found = std::sscanf(reason.c_str() + at, "--frames %" SCNd64 ":%" SCNd64, &range.first, &range.last);
  return found == 2 ? std::optional(range) : std::nullopt;
}

TEST_F(FilmTimes, TheAdviceOnAFilmMostlyWithoutItsSoundHelpsWhenItIsFollowed) {
  film("flame.y4m");
  sound("puff.wav", 0.3, 0.6, 1.9);
  made("-i flame.y4m -i puff.wav -c:a aac -pix_fmt yuv420p short.mp4");
  const std::string reason = captured("short.mp4").report.verdict->reason;
  EXPECT_THAT(reason, HasSubstr("its sound is missing for 5"));
  EXPECT_THAT(reason, Not(HasSubstr("--flame")));
  const auto part = advised(reason);
  ASSERT_TRUE(part) << reason;
  FlameCapture options;
  options.frames = *part;
  const auto clip = capture(folder_ / "short.mp4", options);
  ASSERT_TRUE(clip) << clip.error().message;
  EXPECT_TRUE(clip->report.verdict->usable) << clip->report.verdict->reason;
}

TEST_F(FilmTimes, NoAdviceIsGivenWhereNothingHelpsAgainstMissingSound) {
  film("flame.y4m");
  sound("puff.wav", 0.3, 0.6, 1);
  made("-i flame.y4m -i puff.wav -c:a aac -pix_fmt yuv420p short.mp4");
  EXPECT_THAT(captured("short.mp4").report.verdict->reason, Not(HasSubstr("--f")));
}

TEST_F(FilmTimes, AFilmTakenAtAnotherRateKeepsItsSoundBesideIt) {
  film("flame.y4m");
  sound("puff.wav", 2, 2.6);
  made("-i flame.y4m -i puff.wav -c:a aac -pix_fmt yuv420p film.mp4");
  EXPECT_NEAR(static_cast<double>(first_wind(captured("film.mp4"))), 2 * kRate, 2);
  for (const double rate : {2.0 * kRate, 0.5 * kRate}) {
    EXPECT_NEAR(static_cast<double>(first_wind(captured("film.mp4", rate))), 2 * kRate, 2) << rate;
    const auto wind = hear_wind(folder_ / "film.mp4", rate, kFrames);
    ASSERT_TRUE(wind) << wind.error().message;
    EXPECT_EQ(wind->uncovered, 0u) << rate;
    EXPECT_LT(wind->frames[2 * kRate - 4].rms, 0.1 * wind->frames[2 * kRate + 4].rms) << rate;
  }
}

TEST_F(FilmTimes, SoundThatAnotherRateMakesTooFastIsRefusedWithWhatToDo) {
  film("flame.y4m");
  sound("puff.wav", 2, 2.6);
  made("-i flame.y4m -i puff.wav -c:a pcm_s16le -pix_fmt yuv420p film.mov");
  FlameCapture options;
  options.rate_hz = 13 * kRate;
  const auto clip = capture(folder_ / "film.mov", options);
  ASSERT_FALSE(clip);
  EXPECT_THAT(clip.error().message,
              HasSubstr("the sound's rate is 208000 Hz, expected 8000 to 192000 Hz; give the film "
                        "without it"));
}

// With another rate, too, glimpses are spread over the whole film: key frames at 0, 1, 2 and 3 s.
TEST_F(FilmTimes, AnotherRateLeavesGlimpsesWhereTheyAre) {
  film("flame.y4m");
  made("-i flame.y4m -g 25 -keyint_min 25 -sc_threshold 0 -pix_fmt yuv420p film.mkv");
  for (const double rate : {0.0, 12.5, 50.0}) {
    auto reader = VideoReader::open(folder_ / "film.mkv", {.rate_hz = rate, .frames = {}});
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_EQ(reader->glimpses(4).size(), 3u) << rate;
  }
}

// A phone lowers its rate in the dark: 30 frames a second, then 12. The sound does not.
TEST_F(FilmTimes, FramesAndSoundArePlacedByTheirTimesWhereTheRateChanges) {
  film("flame.y4m", 80);
  const double lit = 50 / 30.0 + 30 / 12.0;
  sound("puff.wav", lit, lit + 0.6, 6);
  made(
      "-i flame.y4m -i puff.wav -vf \"settb=1/600,setpts='if(lt(N,50),N*20,1000+(N-50)*50)'\" -vsync passthrough "
      "-enc_time_base 1/600 -c:a aac -pix_fmt yuv420p dim.mp4");
  auto reader = VideoReader::open(folder_ / "dim.mp4");
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_DOUBLE_EQ(reader->info().rate_hz, 30);
  const auto rows = places(*reader);
  ASSERT_EQ(rows.size(), static_cast<std::size_t>(kFrames));
  EXPECT_NEAR(static_cast<double>(rows[80]), lit * 30, 1);
  const Captured clip = captured("dim.mp4");
  EXPECT_NEAR(static_cast<double>(first_wind(clip)), lit * 30, 3);
  EXPECT_FALSE(clip.report.verdict->usable);
  EXPECT_THAT(clip.report.verdict->reason, HasSubstr("its frames come irregularly"));
}

// A phone that trims a film keeps all frames in the file and says which to show.
TEST_F(FilmTimes, AFilmThatWasTrimmedIsNotCutOff) {
  film("flame.y4m");
  made("-i flame.y4m -g 50 -pix_fmt yuv420p whole.mp4");
  made("-ss 1.3 -i whole.mp4 -c copy trimmed.mp4");
  auto reader = VideoReader::open(folder_ / "trimmed.mp4");
  ASSERT_TRUE(reader) << reader.error().message;
  const auto rows = places(*reader);
  EXPECT_LT(rows.size(), static_cast<std::size_t>(kFrames));
  EXPECT_EQ(reader->info().frames, static_cast<std::int64_t>(rows.size()));
  EXPECT_THAT(reader->warnings(), IsEmpty());
}

TEST_F(FilmTimes, AFilmThatBeginsLateIsNotCutOff) {
  film("flame.y4m");
  made("-i flame.y4m -pix_fmt yuv420p -output_ts_offset 95443 late.mkv");
  auto reader = VideoReader::open(folder_ / "late.mkv");
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_NEAR(static_cast<double>(reader->info().frames), kFrames, 2);
  EXPECT_EQ(places(*reader).size(), static_cast<std::size_t>(kFrames));
  EXPECT_THAT(reader->warnings(), IsEmpty());
}

// Browsers and phones stop the sound after the picture, and some containers state the longer length alone.
TEST_F(FilmTimes, AFilmWhoseSoundIsLongerIsCutOffOnlyWhereItIsHalved) {
  film("flame.y4m");
  sound("puff.wav", 0.3, 0.6, 6);
  for (const std::string name : {"film.mkv", "film.avi", "film.mov"}) {
    made("-i flame.y4m -i puff.wav -c:v mjpeg -c:a pcm_s16le -pix_fmt yuvj420p -movflags +faststart " + name);
    const auto warnings = [&] {
      auto reader = VideoReader::open(folder_ / name);
      EXPECT_TRUE(reader) << name;
      places(*reader);
      return reader->warnings();
    };
    EXPECT_THAT(warnings(), IsEmpty()) << name;
    std::filesystem::resize_file(folder_ / name, std::filesystem::file_size(folder_ / name) / 2);
    EXPECT_THAT(warnings(), Contains(HasSubstr("cut off"))) << name;
  }
}

TEST_F(FilmTimes, AHalvedSoundFileIsNamedInEveryContainerThatStatesItsLength) {
  sound("puff.wav", 0.3, 0.6, 6);
  for (const std::string name : {"half.flac", "half.mka", "half.m4a", "half.aiff", "half.caf", "half.au", "half.w64"}) {
    made("-i puff.wav " + std::string(name == "half.m4a" ? "-c:a aac -movflags +faststart " : "") + name);
    const auto whole = hear_wind(folder_ / name, kRate);
    EXPECT_TRUE(whole) << whole.error().message;
    std::filesystem::resize_file(folder_ / name, std::filesystem::file_size(folder_ / name) / 2);
    const auto half = hear_wind(folder_ / name, kRate);
    ASSERT_FALSE(half) << name;
    EXPECT_THAT(half.error().message, HasSubstr("it was cut off after")) << name;
  }
}

TEST_F(FilmTimes, PixelsThatAreNotSquareAreStretched) {
  film("flame.y4m");
  made("-i flame.y4m -vf setsar=2 -pix_fmt yuv420p wide.mp4");
  made("-i flame.y4m -vf setsar=1/2 -pix_fmt yuv420p high.mp4");
  made("-i flame.y4m -pix_fmt yuv420p plain.mp4");
  const auto width = [&](const Captured& clip) {
    const auto left = samples_of(clip, "p0.x"), right = samples_of(clip, "p7.x");
    return right[50] - left[50];
  };
  const Captured plain = captured("plain.mp4"), wide = captured("wide.mp4"), high = captured("high.mp4");
  EXPECT_NEAR(width(wide) / width(plain), 2, 0.1);
  EXPECT_NEAR(samples_of(high, "base.y")[50] / samples_of(plain, "base.y")[50], 2, 0.02);
  EXPECT_NEAR(width(high) / width(plain), 1, 0.05);
  EXPECT_THAT(wide.report.warnings, Contains(HasSubstr("its pixels are 2 times as wide as high; places are in square "
                                                       "ones, in a picture of 320 x 180")));
  auto reader = VideoReader::open(folder_ / "wide.mp4");
  ASSERT_TRUE(*reader->next());
  EXPECT_EQ(reader->rgb().width, 320);
  made("-i flame.y4m -vf setsar=20 -pix_fmt yuv420p absurd.mp4");
  const auto refused = VideoReader::open(folder_ / "absurd.mp4");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("20 times as wide as high; convert it to square ones"));
}

TEST_F(FilmTimes, StretchingKeepsTheFullRangeOfJpegPictures) {
  film("flame.y4m");
  const auto light = [&](const std::string& how) {
    made("-i flame.y4m " + how + " -c:v mjpeg -q:v 2 -pix_fmt yuvj420p film.mov");
    auto reader = VideoReader::open(folder_ / "film.mov");
    EXPECT_TRUE(reader && reader->next());
    const RgbImage image = reader->rgb();
    return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0) / static_cast<double>(image.pixels.size());
  };
  EXPECT_NEAR(light("-vf setsar=2"), light(""), 2);
}

TEST_F(FilmTimes, ProgressEndsAtOneForAPartOfAFilmToo) {
  film("flame.y4m");
  made("-i flame.y4m -pix_fmt yuv420p film.mp4");
  std::vector<double> shares{0};
  const auto progress = [&](std::string_view, double share) {
    shares.push_back(share);
    return true;
  };
  support::ClipCaptureOptions options;
  options.video.frames = FrameRange{11, 60};
  ASSERT_TRUE(support::capture_outline(folder_ / "film.mp4", options, progress));
  EXPECT_EQ(shares.back(), 1);
  shares = {0};
  ASSERT_TRUE(capture_brightness(folder_ / "film.mp4", {.frames = FrameRange{11, 60}}, progress));
  EXPECT_EQ(shares.back(), 1);
}

TEST_F(FilmTimes, AFilmWithoutAReadableFrameIsNotCalledBlack) {
  film("flame.y4m");
  made("-i flame.y4m -pix_fmt yuv420p film.mp4");
  std::fstream file(folder_ / "film.mp4", std::ios::in | std::ios::out | std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  const std::size_t begin = bytes.find("mdat") + 4;
  file.seekp(static_cast<std::streamoff>(begin));
  file << std::string(bytes.rfind("moov") - 4 - begin, '\0');
  file.close();
  const auto light = capture_brightness(folder_ / "film.mp4", {});
  ASSERT_FALSE(light);
  EXPECT_THAT(light.error().message, HasSubstr("has no frame that can be read"));
}

TEST_F(FilmTimes, ViewsAreJoinedByTheSoundFromTheirFirstReadableFrameOn) {
  film("flame.y4m");
  sound("puff.wav", 2, 2.6);
  made("-i flame.y4m -i puff.wav -g 25 -keyint_min 25 -sc_threshold 0 -bf 0 -pix_fmt yuv420p -c:a pcm_s16le front.mkv");
  // Without its first key frame, the next one, after a second, is the first frame that can be decoded.
  made("-i front.mkv -c copy -bsf:v \"noise=drop='eq(n,0)'\" side.mkv");
  const auto joined =
      capture_views(std::vector{folder_ / "front.mkv", folder_ / "side.mkv"}, std::vector{0.0, 90.0}, {});
  ASSERT_TRUE(joined) << joined.error().message;
  const auto& row = joined->report.sections[0].tables[0].rows[1];
  EXPECT_NEAR(std::get<double>(row[5]), 1, 0.05);  // seconds by the sound
}

TEST_F(FilmTimes, ViewsMayBeCutOff) {
  film("flame.y4m");
  sound("puff.wav", 2, 2.6);
  made("-i flame.y4m -i puff.wav -g 25 -keyint_min 25 -sc_threshold 0 -bf 0 -pix_fmt yuv420p -c:a pcm_s16le front.mkv");
  std::filesystem::copy_file(folder_ / "front.mkv", folder_ / "side.mkv");
  std::filesystem::resize_file(folder_ / "side.mkv", std::filesystem::file_size(folder_ / "side.mkv") * 8 / 10);
  const auto joined =
      capture_views(std::vector{folder_ / "front.mkv", folder_ / "side.mkv"}, std::vector{0.0, 90.0}, {});
  ASSERT_TRUE(joined) << joined.error().message;
  EXPECT_LT(joined->recording.rows(), static_cast<std::size_t>(kFrames));
  EXPECT_THAT(joined->report.warnings, Contains(HasSubstr("side.mkv: cut off")));
}

TEST_F(FilmTimes, AnEvenFilmIsLeftAsItIs) {
  film("flame.y4m");
  made("-i flame.y4m -pix_fmt yuv420p even.mkv");
  EXPECT_THAT(captured("even.mkv").report.warnings, Not(Contains(HasSubstr("irregular"))));
}

}  // namespace
}  // namespace wisp::film_times_test
