#include "wisp/draw/video_writer.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstring>

#include "draw/draw_test_pictures.hpp"
#include "wisp/base/file.hpp"

namespace wisp::video_writer_test {
namespace {

Image moving_square(int width, int height, int frame) {
  Image image(width, height, {20, 30, 60, 255});
  for (int y = height / 4; y < height / 2; ++y) {
    for (int x = frame % width; x < std::min(width, frame % width + width / 4); ++x) image.row(y)[x] = 0xFFFFA020U;
  }
  return image;
}

// Fields of the file's stream as ffprobe prints them, one a line: name=value.
std::string probed(const std::filesystem::path& path, const std::string& stream, const std::string& fields) {
  return output_of("ffprobe -v error -count_frames -select_streams " + stream + " -show_entries stream=" + fields +
                   " -of default=noprint_wrappers=1 '" + path.string() + "'");
}

std::vector<std::uint8_t> decoded(const std::filesystem::path& path, const std::string& pixel_format) {
  const std::string raw =
      output_of("ffmpeg -v error -i '" + path.string() + "' -f rawvideo -pix_fmt " + pixel_format + " -");
  return {raw.begin(), raw.end()};
}

#define REQUIRE_FFMPEG()                                                     \
  if (!has_program("ffmpeg") || !has_program("ffprobe")) {                   \
    GTEST_SKIP() << "no ffmpeg and ffprobe programs to read the clips with"; \
  }

void write_clip(const std::filesystem::path& path, const VideoWriterOptions& options, int frames) {
  auto writer = VideoWriter::create(path, options);
  ASSERT_TRUE(writer) << writer.error().message;
  for (int frame = 0; frame < frames; ++frame) {
    const auto written = writer->write(moving_square(options.width, options.height, frame));
    ASSERT_TRUE(written) << written.error().message;
  }
  const auto finished = writer->finish();
  ASSERT_TRUE(finished) << finished.error().message;
}

TEST(VideoWriter, AClipHasItsFramesSizeAndRate) {
  REQUIRE_FFMPEG();
  const TestFolder folder("video-basic");
  write_clip(folder / "a.mp4", {.width = 64, .height = 48, .rate_hz = 25}, 33);
  const std::string text =
      probed(folder / "a.mp4", "v:0", "codec_name,pix_fmt,width,height,r_frame_rate,avg_frame_rate,nb_read_frames");
  EXPECT_NE(text.find("codec_name=h264"), std::string::npos);
  EXPECT_NE(text.find("pix_fmt=yuv420p"), std::string::npos);
  EXPECT_NE(text.find("width=64"), std::string::npos);
  EXPECT_NE(text.find("height=48"), std::string::npos);
  EXPECT_NE(text.find("r_frame_rate=25/1"), std::string::npos);
  EXPECT_NE(text.find("avg_frame_rate=25/1"), std::string::npos);
  EXPECT_NE(text.find("nb_read_frames=33"), std::string::npos) << text;
}

TEST(VideoWriter, TelevisionRatesAreKeptExactly) {
  REQUIRE_FFMPEG();
  const TestFolder folder("video-rate");
  write_clip(folder / "a.mp4", {.width = 32, .height = 32, .rate_hz = 30000.0 / 1001}, 4);
  EXPECT_NE(probed(folder / "a.mp4", "v:0", "r_frame_rate").find("30000/1001"), std::string::npos);
}

TEST(VideoWriter, OddSizesArePaddedToEven) {
  REQUIRE_FFMPEG();
  const TestFolder folder("video-odd");
  write_clip(folder / "a.mp4", {.width = 63, .height = 47, .rate_hz = 30}, 3);
  const std::string text = probed(folder / "a.mp4", "v:0", "width,height,nb_read_frames");
  EXPECT_NE(text.find("width=64"), std::string::npos);
  EXPECT_NE(text.find("height=48"), std::string::npos);
  EXPECT_NE(text.find("nb_read_frames=3"), std::string::npos);
}

TEST(VideoWriter, ColoursSurvive) {
  REQUIRE_FFMPEG();
  const TestFolder folder("video-colour");
  auto writer = VideoWriter::create(folder / "a.mp4", {.width = 64, .height = 64, .rate_hz = 10});
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->write(Image(64, 64, {230, 120, 40, 255})));
  ASSERT_TRUE(writer->finish());
  const auto rgb = decoded(folder / "a.mp4", "rgb24");
  ASSERT_EQ(rgb.size(), 64U * 64 * 3);
  const std::size_t middle = (32 * 64 + 32) * 3;
  EXPECT_NEAR(rgb[middle], 230, 4);
  EXPECT_NEAR(rgb[middle + 1], 120, 4);
  EXPECT_NEAR(rgb[middle + 2], 40, 4);
}

TEST(VideoWriter, SaysThatItsColoursAreBt709) {
  REQUIRE_FFMPEG();
  const TestFolder folder("video-tags");
  write_clip(folder / "a.mp4", {.width = 32, .height = 32, .rate_hz = 30}, 2);
  const std::string text = probed(folder / "a.mp4", "v:0", "color_range,color_space,color_transfer,color_primaries");
  EXPECT_NE(text.find("color_range=tv"), std::string::npos);
  EXPECT_NE(text.find("color_space=bt709"), std::string::npos);
  EXPECT_NE(text.find("color_transfer=bt709"), std::string::npos);
  EXPECT_NE(text.find("color_primaries=bt709"), std::string::npos);
}

TEST(VideoWriter, SoundHasItsLengthAndPitch) {
  REQUIRE_FFMPEG();
  const TestFolder folder("video-sound");
  constexpr int kRate = 44100;
  auto writer =
      VideoWriter::create(folder / "a.mp4", {.width = 32, .height = 32, .rate_hz = 20, .sound_rate_hz = kRate});
  ASSERT_TRUE(writer) << writer.error().message;
  std::vector<float> tone(2 * kRate);
  for (std::size_t k = 0; k < tone.size(); ++k)
    tone[k] = 0.5F * std::sin(static_cast<float>(k) * 2 * 3.1415927F * 441 / kRate);
  // In pieces of any size, some before the frames that they belong to and some after.
  ASSERT_TRUE(writer->write_sound(std::span(tone).first(7)));
  for (int frame = 0; frame < 40; ++frame) ASSERT_TRUE(writer->write(moving_square(32, 32, frame)));
  ASSERT_TRUE(writer->write_sound(std::span(tone).subspan(7, 50000)));
  ASSERT_TRUE(writer->write_sound(std::span(tone).subspan(50007)));
  ASSERT_TRUE(writer->finish());

  const std::string text = probed(folder / "a.mp4", "a:0", "codec_name,sample_rate,channels,duration");
  EXPECT_NE(text.find("codec_name=aac"), std::string::npos) << text;
  EXPECT_NE(text.find("sample_rate=44100"), std::string::npos);
  EXPECT_NE(text.find("channels=1"), std::string::npos);
  const std::size_t duration = text.find("duration=");
  ASSERT_NE(duration, std::string::npos);
  EXPECT_NEAR(std::stod(text.substr(duration + 9)), 2.0, 0.05);
  const std::string raw = output_of("ffmpeg -v error -i '" + (folder / "a.mp4").string() + "' -f s16le -ac 1 -");
  std::vector<std::int16_t> samples(raw.size() / 2);
  std::memcpy(samples.data(), raw.data(), samples.size() * 2);
  EXPECT_NEAR(static_cast<double>(samples.size()), 2.0 * kRate, 2100);
  int crossings = 0;
  double square = 0;
  for (std::size_t k = 20000; k < 60000; ++k) {
    crossings += (samples[k - 1] < 0) != (samples[k] < 0) ? 1 : 0;
    square += static_cast<double>(samples[k]) * samples[k];
  }
  EXPECT_NEAR(crossings, 40000 * 2 * 441.0 / kRate, 4);
  EXPECT_NEAR(std::sqrt(square / 40000) / 32768, 0.5 / std::sqrt(2.0), 0.02);
}

TEST(VideoWriter, SoundThatIsNotANumberIsSilence) {
  REQUIRE_FFMPEG();
  const TestFolder folder("video-nan");
  auto writer =
      VideoWriter::create(folder / "a.mp4", {.width = 32, .height = 32, .rate_hz = 20, .sound_rate_hz = 44100});
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->write(moving_square(32, 32, 0)));
  const std::vector<float> bad(30000, std::nanf(""));
  ASSERT_TRUE(writer->write_sound(bad));
  ASSERT_TRUE(writer->finish());
  EXPECT_NE(probed(folder / "a.mp4", "a:0", "codec_name").find("aac"), std::string::npos);
}

TEST(VideoWriter, IndexStandsBeforeTheDataForTheWeb) {
  const TestFolder folder("video-faststart");
  write_clip(folder / "a.mp4", {.width = 64, .height = 48, .rate_hz = 25}, 10);
  const auto bytes = read_file(folder / "a.mp4");
  ASSERT_TRUE(bytes);
  const std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  ASSERT_NE(text.find("moov"), std::string::npos);
  EXPECT_LT(text.find("moov"), text.find("mdat"));
}

TEST(VideoWriter, AbandonedItLeavesNothing) {
  const TestFolder folder("video-abandoned");
  {
    auto writer = VideoWriter::create(folder / "a.mp4", {.width = 64, .height = 48, .rate_hz = 25});
    ASSERT_TRUE(writer);
    for (int frame = 0; frame < 60; ++frame) ASSERT_TRUE(writer->write(moving_square(64, 48, frame)));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.mp4"));
  }
  EXPECT_TRUE(folder.empty());
}

TEST(VideoWriter, AnOldClipStaysUntilTheNewOneIsFinished) {
  const TestFolder folder("video-old");
  ASSERT_TRUE(write_file(folder / "a.mp4", "the old one"));
  {
    auto writer = VideoWriter::create(folder / "a.mp4", {.width = 64, .height = 48, .rate_hz = 25});
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->write(moving_square(64, 48, 0)));
  }
  EXPECT_EQ(std::filesystem::file_size(folder / "a.mp4"), 11U);
  write_clip(folder / "a.mp4", {.width = 64, .height = 48, .rate_hz = 25}, 2);
  EXPECT_GT(std::filesystem::file_size(folder / "a.mp4"), 500U);
}

TEST(VideoWriter, ANameWithAColonIsNoProtocol) {
  const TestFolder folder("video-colon");
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder / "");
  for (const char* name : {"12:30.mp4", "12:30.apng"}) {
    write_clip(name, {.width = 64, .height = 48, .rate_hz = 25}, 2);
    EXPECT_TRUE(std::filesystem::exists(name)) << name;
  }
  std::filesystem::current_path(before);
}

TEST(VideoWriter, WithoutFramesThereIsNoClip) {
  const TestFolder folder("video-none");
  auto writer = VideoWriter::create(folder / "a.mp4", {.width = 64, .height = 48, .rate_hz = 25});
  ASSERT_TRUE(writer);
  const auto finished = writer->finish();
  ASSERT_FALSE(finished);
  EXPECT_NE(finished.error().message.find("no frame"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.mp4"));
}

TEST(VideoWriter, AFrameOfAnotherSizeIsNamed) {
  const TestFolder folder("video-size");
  auto writer = VideoWriter::create(folder / "a.mp4", {.width = 64, .height = 48, .rate_hz = 25});
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->write(moving_square(64, 48, 0)));
  const auto other = writer->write(Image(32, 48));
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("frame 1 is 32 x 48 pixels, expected 64 x 48"), std::string::npos);
}

TEST(VideoWriter, WhatCannotBeIsRefusedBeforeAnyFile) {
  const TestFolder folder("video-options");
  const VideoWriterOptions good{.width = 64, .height = 48, .rate_hz = 25};
  std::vector<VideoWriterOptions> bad(7, good);
  bad[0].width = 1;
  bad[1].height = 100000;
  bad[2].rate_hz = 0;
  bad[3].rate_hz = std::nan("");
  bad[4].crf = 60;
  bad[5].sound_rate_hz = 100;
  bad[6].sound_rate_hz = 44101;
  for (std::size_t k = 0; k < bad.size(); ++k) {
    const auto writer = VideoWriter::create(folder / "a.mp4", bad[k]);
    ASSERT_FALSE(writer) << k;
    EXPECT_NE(writer.error().message.find("a.mp4"), std::string::npos) << k;
  }
  EXPECT_FALSE(VideoWriter::create(folder / "nowhere/a.mp4", good));
  EXPECT_TRUE(folder.empty());
}

TEST(VideoWriter, NothingCanBeAddedAfterTheEnd) {
  const TestFolder folder("video-end");
  auto writer =
      VideoWriter::create(folder / "a.mp4", {.width = 64, .height = 48, .rate_hz = 25, .sound_rate_hz = 44100});
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->write(moving_square(64, 48, 0)));
  ASSERT_TRUE(writer->finish());
  EXPECT_FALSE(writer->write(moving_square(64, 48, 1)));
  EXPECT_FALSE(writer->write_sound(std::vector<float>(10)));
  EXPECT_FALSE(writer->finish());
}

TEST(VideoWriter, SoundWithoutATrackForItIsRefused) {
  const TestFolder folder("video-mute");
  auto writer = VideoWriter::create(folder / "a.mp4", {.width = 64, .height = 48, .rate_hz = 25});
  ASSERT_TRUE(writer);
  EXPECT_FALSE(writer->write_sound(std::vector<float>(10)));
}

// Frames that hardly compress, so that files grow.
Image noise(int frame) {
  Image image(160, 120);
  for (std::size_t k = 0; k < image.pixels().size(); ++k) {
    const auto word = static_cast<std::uint32_t>(k + 1) * 2654435761U + static_cast<std::uint32_t>(frame) * 40503U;
    image.pixels()[k] = 0xFF000000U | (word ^ word >> 13) >> 8;
  }
  return image;
}

// Whether a clip of noise could be written with files held to that size.
bool writes_noise(const std::filesystem::path& path, rlim_t largest_file) {
  rlimit before{};
  if (::getrlimit(RLIMIT_FSIZE, &before) != 0) return false;
  rlimit tight = before;
  tight.rlim_cur = largest_file;
  if (::setrlimit(RLIMIT_FSIZE, &tight) != 0) return false;
  bool good = true;
  {
    auto writer = VideoWriter::create(path, {.width = 160, .height = 120, .rate_hz = 25, .crf = 10, .threads = 1});
    good = static_cast<bool>(writer);
    for (int frame = 0; good && frame < 12; ++frame) good = static_cast<bool>(writer->write(noise(frame)));
    good = good && static_cast<bool>(writer->finish());
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  return good;
}

TEST(VideoWriter, AFullDiskIsReportedAndLeavesNothing) {
  // A limit on the size of files fails writes as a full disk does. It is met while frames are written, at the end, and
  // when the index is moved to the front.
  const TestFolder folder("video-full");
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  EXPECT_TRUE(writes_noise(folder / "whole.mp4", RLIM_INFINITY));
  const auto size = std::filesystem::file_size(folder / "whole.mp4");
  std::filesystem::remove(folder / "whole.mp4");
  ASSERT_GT(size, 80000U);
  for (const rlim_t limit :
       {rlim_t{1}, rlim_t{1000}, rlim_t{size / 2}, rlim_t{size - 40000}, rlim_t{size - 300}, rlim_t{size - 1}}) {
    EXPECT_FALSE(writes_noise(folder / "a.mp4", limit)) << limit << " of " << size;
    EXPECT_TRUE(folder.empty()) << limit;
  }
  EXPECT_TRUE(writes_noise(folder / "a.mp4", size));
  std::signal(SIGXFSZ, handler);
}

TEST(VideoWriter, SaysNothingOnTheTerminal) {
  const TestFolder folder("video-quiet");
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  auto writer =
      VideoWriter::create(folder / "a.mp4", {.width = 64, .height = 48, .rate_hz = 25, .sound_rate_hz = 44100});
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->write(moving_square(64, 48, 0)));
  ASSERT_TRUE(writer->write_sound(std::vector<float>(5000)));
  ASSERT_TRUE(writer->finish());
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace wisp::video_writer_test
