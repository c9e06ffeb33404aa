#include "wisp/capture/media/video.hpp"

#include <sys/stat.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <iterator>
#include <new>

#include "capture/media/libav.hpp"
#include "capture/support/clip_files.hpp"

namespace wisp::video_test {
namespace {

using support::Plane;
using support::RawVideo;
using support::ScratchFolder;
using testing::HasSubstr;

constexpr VideoOptions kThirty{.rate_hz = 30, .frames = std::nullopt, .threads = 1};

std::string error_of(const std::filesystem::path& path, const VideoOptions& options = {}) {
  auto reader = VideoReader::open(path, options);
  if (!reader) return reader.error().message;
  while (true) {
    auto frame = reader->next();
    if (!frame) return frame.error().message;
    if (!frame->has_value()) return "";
  }
}

// Places on the grid and a pixel of each frame.
struct Seen {
  std::vector<std::int64_t> index;
  std::vector<int> pixel;
};

Seen see(VideoReader& reader) {
  Seen seen;
  while (true) {
    auto frame = reader.next();
    if (!frame || !frame->has_value()) return seen;
    seen.index.push_back((*frame)->index);
    seen.pixel.push_back(plane_in_place((*frame)->picture, PixelChannel::kLuma).at(3, 2));
  }
}

// FFmpeg's H.264 decoder drops a picture for which an allocation failed and returns success.
TEST(Decoding, FailedAllocationInErrnoThrows) {
  const auto fails_quietly = [] {
    errno = ENOMEM;
    return 0;
  };
  EXPECT_THROW(with_memory(fails_quietly), std::bad_alloc);
  EXPECT_THROW(with_memory([] { return -ENOMEM; }), std::bad_alloc);
  EXPECT_EQ(with_memory([](int code) { return code; }, -5), -5);
}

// Of encoders and of malloc, which go on after a failure of their own.
TEST(Decoding, WhatOthersLeftInErrnoIsNoFailure) {
  errno = ENOMEM;
  EXPECT_EQ(with_memory([] { return 0; }), 0);
}

TEST(ImageFolder, IsReadInTheOrderOfItsNumbers) {
  ScratchFolder folder("numbers");
  for (const int number : {2, 10, 1, 9}) {
    write_pgm(folder / ("flame" + std::to_string(number) + ".pgm"), Plane(16, 12, static_cast<std::uint8_t>(number)));
  }
  support::write_pgm(folder / "cover.pgm", Plane(99, 99));  // no number, no frame
  auto reader = VideoReader::open(folder.path(), kThirty);
  ASSERT_TRUE(reader);
  EXPECT_TRUE(reader->info().images);
  EXPECT_EQ(reader->info().frames, 4);
  EXPECT_EQ(see(*reader).pixel, (std::vector<int>{1, 2, 9, 10}));
}

TEST(ImageFolder, MissingNumbersAreLostFrames) {
  ScratchFolder folder("gaps");
  for (const int number : {10, 20, 40, 50}) {
    write_pgm(folder / (std::to_string(number) + ".pgm"), Plane(16, 12));
  }
  auto reader = VideoReader::open(folder.path(), kThirty);
  EXPECT_EQ(see(*reader).index, (std::vector<std::int64_t>{0, 1, 3, 4}));
}

// A number that was mistyped must not become millions of lost frames.
TEST(ImageFolder, ALongHoleInTheNumbersIsTakenAsTwoSeconds) {
  for (const char* last : {"30000000", "999999999999999999"}) {
    ScratchFolder folder("far");
    for (const char* number : {"1", "2", "3", last}) write_pgm(folder / (std::string(number) + ".pgm"), Plane(16, 12));
    auto reader = VideoReader::open(folder.path(), kThirty);
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_EQ(see(*reader).index, (std::vector<std::int64_t>{0, 1, 2, 63}));
    ASSERT_EQ(reader->warnings().size(), 1u);
    EXPECT_THAT(reader->warnings().front(), HasSubstr("1 hole of more than 2 s"));
  }
}

// Names may also state how many there are, or the picture's height.
TEST(ImageFolder, ImagesAreNumberedByTheDigitsInWhichTheyDiffer) {
  ScratchFolder folder("of");
  for (const int number : {2, 10, 1, 9}) {
    write_pgm(folder / ("flame_" + std::to_string(number) + "_of_20_720p.pgm"),
              Plane(16, 12, static_cast<std::uint8_t>(number)));
  }
  auto reader = VideoReader::open(folder.path(), kThirty);
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(see(*reader).pixel, (std::vector<int>{1, 2, 9, 10}));
}

TEST(ImageFolder, ANumberThatNoCounterHoldsIsNamed) {
  ScratchFolder folder("digits");
  write_pgm(folder / "1.pgm", Plane(16, 12));
  write_pgm(folder / "9999999999999999999.pgm", Plane(16, 12));
  EXPECT_THAT(error_of(folder.path(), kThirty), HasSubstr("its number has 19 digits, expected 1 to 18"));
}

TEST(ImageFolder, APipeAmongTheImagesIsNamedAndNotWaitedFor) {
  ScratchFolder folder("pipe");
  write_pgm(folder / "000.pgm", Plane(16, 12));
  ASSERT_EQ(::mkfifo((folder / "001.pgm").c_str(), 0600), 0);
  EXPECT_THAT(error_of(folder.path(), kThirty), HasSubstr("001.pgm: is no plain file"));
  EXPECT_THAT(error_of(folder / "001.pgm"), HasSubstr("a device or a pipe"));
}

TEST(ImageFolder, AnImageThatClaimsGigapixelsIsNamed) {
  ScratchFolder folder("claims");
  std::ofstream(folder / "000.pgm") << "P5\n60000 60000\n255\nshort";
  EXPECT_THAT(error_of(folder.path(), kThirty), testing::AllOf(HasSubstr("000.pgm: the image cannot be decoded"),
                                                               HasSubstr("larger than 8192 x 8192 pixels")));
}

TEST(ImageFolder, FfmpegPrintsNothingOfItsOwn) {
  ScratchFolder folder("loud");
  std::ofstream(folder / "000.png") << "no image";
  testing::internal::CaptureStderr();
  EXPECT_THAT(error_of(folder.path(), kThirty), HasSubstr("000.png"));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(ImageFolder, OfAnotherSizeIsNamed) {
  ScratchFolder folder("sizes");
  write_pgm(folder / "000.pgm", Plane(16, 12));
  write_pgm(folder / "001.pgm", Plane(20, 12));
  const std::string message = error_of(folder.path(), kThirty);
  EXPECT_THAT(message, HasSubstr("001.pgm"));
  EXPECT_THAT(message, HasSubstr("20 x 12"));
  EXPECT_THAT(message, HasSubstr("16 x 12"));
}

TEST(ImageFolder, StatesTheSizeOfTurnedPictures) {
  ScratchFolder folder("sideways");
  write_pgm(folder / "1.pgm", Plane(16, 12));
  auto reader = VideoReader::open(folder.path(), {.rate_hz = 30, .frames = std::nullopt, .turn = 1});
  ASSERT_TRUE(reader) << reader.error().message;
  const auto frame = reader->next();
  ASSERT_TRUE(frame && frame->has_value());
  EXPECT_EQ(reader->info().width, 12);
  EXPECT_EQ(reader->info().height, 16);
  EXPECT_EQ((*frame)->picture.width, 12);
}

TEST(ImageFolder, NeedsARateAndImages) {
  ScratchFolder folder("empty");
  EXPECT_THAT(error_of(folder.path()), HasSubstr("--rate"));
  EXPECT_THAT(error_of(folder.path(), kThirty), HasSubstr("no numbered images"));
}

TEST(ImageFolder, ABrokenImageIsNamed) {
  ScratchFolder folder("broken");
  write_pgm(folder / "000.pgm", Plane(16, 12));
  std::ofstream(folder / "001.pgm") << "no image";
  EXPECT_THAT(error_of(folder.path(), kThirty), HasSubstr("001.pgm"));
}

TEST(ImageFolder, AnImageThatIsCutShortIsNamed) {
  if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) GTEST_SKIP() << "no ffmpeg program to make images with";
  for (const char* name : {"1.jpg", "1.png"}) {
    ScratchFolder folder("cut");
    write_pgm(folder / "picture.pgm", support::flame_picture(support::Flame{}));
    const std::string made =
        "ffmpeg -v error -i '" + (folder / "picture.pgm").string() + "' '" + (folder / name).string() + "'";
    ASSERT_EQ(std::system(made.c_str()), 0);
    EXPECT_EQ(error_of(folder.path(), kThirty), "") << name;
    const auto size = std::filesystem::file_size(folder / name);
    std::ofstream(folder / name, std::ios::app | std::ios::binary) << "a phone's short film \xff\xda of the moment";
    EXPECT_EQ(error_of(folder.path(), kThirty), "") << name;
    std::filesystem::resize_file(folder / name, size * 2 / 3);
    EXPECT_THAT(error_of(folder.path(), kThirty), HasSubstr("the image is cut short; remove or replace it")) << name;
  }
}

TEST(ImageFolder, NotesThatOtherSystemsLeaveBesideImagesAreNone) {
  ScratchFolder folder("notes");
  write_pgm(folder / "001.pgm", Plane(16, 12));
  std::ofstream(folder / "._001.pgm") << "Mac OS X";
  EXPECT_EQ(error_of(folder.path(), kThirty), "");
}

TEST(ImageFolder, TwoImagesOfOneNumberAreAnError) {
  ScratchFolder folder("twice");
  write_pgm(folder / "a001.pgm", Plane(16, 12));
  write_pgm(folder / "b001.pgm", Plane(16, 12));
  EXPECT_THAT(error_of(folder.path(), kThirty), HasSubstr("same number"));
}

TEST(VideoFile, GivesItsFramesAndSaysWhatTheyAre) {
  ScratchFolder folder("raw");
  RawVideo video(folder / "clip.y4m", 32, 24, 25);
  for (int k = 0; k < 6; ++k) video.add(Plane(32, 24, static_cast<std::uint8_t>(10 * k)));
  video = RawVideo(folder / "other.y4m", 32, 24, 25);  // closes the first
  auto reader = VideoReader::open(folder / "clip.y4m");
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(reader->info().width, 32);
  EXPECT_EQ(reader->info().height, 24);
  EXPECT_DOUBLE_EQ(reader->info().rate_hz, 25);
  EXPECT_FALSE(reader->info().has_sound);
  const Seen seen = see(*reader);
  EXPECT_EQ(seen.pixel, (std::vector<int>{0, 10, 20, 30, 40, 50}));
  EXPECT_EQ(seen.index, (std::vector<std::int64_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_TRUE(reader->warnings().empty());
}

// FFmpeg knows a file by its contents, whatever it is called, and playlists name other files.
TEST(VideoFile, APlaylistOpensNoOtherFile) {
  ScratchFolder folder("playlist");
  {
    RawVideo video(folder / "secret.y4m", 32, 24, 25);
    for (int k = 0; k < 6; ++k) video.add(Plane(32, 24));
  }
  const std::string secret = (folder / "secret.y4m").string();
  std::ofstream(folder / "hls.mp4") << "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\n"
                                    << secret << "\n#EXT-X-ENDLIST\n";
  std::ofstream(folder / "concat.mp4") << "ffconcat version 1.0\nfile '" << secret << "'\n";
  std::ofstream(folder / "dash.mp4") << "<?xml version=\"1.0\"?><MPD><Period><BaseURL>" << secret
                                     << "</BaseURL></Period></MPD>";
  for (const char* name : {"hls.mp4", "concat.mp4", "dash.mp4"}) {
    EXPECT_THAT(error_of(folder / name), HasSubstr("cannot be read as video or sound")) << name;
  }
}

// A few bytes can hold a black picture of any size, and a decoder keeps up to twenty.
TEST(VideoFile, APictureLargerThan8KIsNamedBeforeItIsDecoded) {
  ScratchFolder folder("large");
  for (const char* size : {"W8193 H4395", "W60000 H601"}) {
    std::ofstream(folder / "clip.y4m") << "YUV4MPEG2 " << size << " F25:1 Ip C420jpeg\nFRAME\nshort";
    EXPECT_THAT(error_of(folder / "clip.y4m"), HasSubstr("pixels, expected at most 8192 x 4320; make it smaller"))
        << size;
  }
}

TEST(VideoFile, ANameWithAColonIsAFilesName) {
  ScratchFolder folder("colon");
  {
    RawVideo video(folder / "concat:clip.y4m", 32, 24, 25);
    for (int k = 0; k < 3; ++k) video.add(Plane(32, 24));
  }
  EXPECT_EQ(error_of(folder / "concat:clip.y4m"), "");
}

TEST(VideoFile, ARangeOfFramesIsCountedFromOne) {
  ScratchFolder folder("range");
  {
    RawVideo video(folder / "clip.y4m", 32, 24, 25);
    for (int k = 0; k < 6; ++k) video.add(Plane(32, 24, static_cast<std::uint8_t>(10 * k)));
  }
  VideoOptions options;
  options.frames = FrameRange{2, 4};
  auto reader = VideoReader::open(folder / "clip.y4m", options);
  EXPECT_EQ(see(*reader).pixel, (std::vector<int>{10, 20, 30}));
  options.frames = FrameRange{7, 9};
  EXPECT_THAT(error_of(folder / "clip.y4m", options), HasSubstr("found 6 frames, expected frame 7"));
  options.frames = FrameRange{4, 2};
  EXPECT_THAT(error_of(folder / "clip.y4m", options), HasSubstr("4:2"));
}

// Widths that are no multiple of a vector's, too: with sanitizers this also sees what is written past a row.
TEST(VideoFile, RgbIsThePictureAsItIsShown) {
  ScratchFolder folder("rgb");
  for (const int width : {32, 34, 52, 1078}) {
    { RawVideo(folder / "clip.y4m", width, 24, 25).add(Plane(width, 24, 90)); }
    auto reader = VideoReader::open(folder / "clip.y4m");
    ASSERT_TRUE(*reader->next());
    const RgbImage image = reader->rgb();
    ASSERT_EQ(image.pixels.size(), 3u * width * 24);
    for (const std::uint8_t value : image.pixels) ASSERT_NEAR(value, (90 - 16) * 255.0 / 219, 1) << width;
  }
}

TEST(VideoFile, WhatIsNoVideoIsAnErrorInOneLine) {
  ScratchFolder folder("bad");
  std::ofstream(folder / "text.mp4") << "Dear diary, today I filmed a candle.\n";
  std::ofstream(folder / "empty.mp4");
  const std::vector<std::int16_t> silence(800);
  support::write_wav(folder / "sound.wav", 8000, 1, silence);
  EXPECT_THAT(error_of(folder / "missing.mp4"), HasSubstr("no such file"));
  EXPECT_THAT(error_of(folder / "text.mp4"), HasSubstr("cannot be read"));
  EXPECT_THAT(error_of(folder / "empty.mp4"), HasSubstr("empty.mp4"));
  EXPECT_THAT(error_of(folder / "sound.wav"), HasSubstr("no video track"));
  for (const char* name : {"missing.mp4", "text.mp4", "empty.mp4", "sound.wav"}) {
    EXPECT_EQ(error_of(folder / name).find('\n'), std::string::npos);
  }
}

TEST(VideoFile, RealClipsSayTheirRateAndFrames) {
  const auto path = support::real_data() / "flame/flame_shaken_1080p60.mp4";
  WISP_NEEDS(path);
  auto reader = VideoReader::open(path);
  ASSERT_TRUE(reader);
  EXPECT_DOUBLE_EQ(reader->info().rate_hz, 60);
  EXPECT_EQ(reader->info().frames, 266);
  EXPECT_TRUE(reader->info().has_sound);
  EXPECT_EQ(see(*reader).index.size(), 266u);
}

TEST(VideoFile, GlimpsesDoNotDisturbTheFrames) {
  const auto path = support::real_data() / "flame/red_candle_720p25.mp4";
  WISP_NEEDS(path);
  auto reader = VideoReader::open(path), undisturbed = VideoReader::open(path);
  EXPECT_EQ(reader->glimpses(4).size(), 3u);  // it has key frames at 3, 6 and 9 s
  for (int k = 0; k < 20; ++k) {
    const auto a = reader->next(), b = undisturbed->next();
    ASSERT_EQ((*a)->index, (*b)->index);
    EXPECT_EQ(plane_in_place((*a)->picture, PixelChannel::kLuma).at(340, 300),
              plane_in_place((*b)->picture, PixelChannel::kLuma).at(340, 300));
  }
}

// A copy of a film that says to be shown by (a b; c d) of its pixels, in the header of its last track.
std::filesystem::path shown_by(const std::filesystem::path& film, std::array<int, 4> matrix,
                               const ScratchFolder& folder) {
  std::ifstream in(film, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const auto put = [](std::string& out, int value) {
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 255);
  };
  const auto stated = [&](std::array<int, 4> m) {
    std::string out;
    for (const int value : {m[0] << 16, m[1] << 16, 0, m[2] << 16, m[3] << 16, 0, 0, 0, 1 << 30}) put(out, value);
    return out;
  };
  const std::size_t at = bytes.find(stated({1, 0, 0, 1}), bytes.rfind("tkhd"));
  bytes.replace(at, 36, stated(matrix));
  std::ofstream(folder / "shown.mp4", std::ios::binary) << bytes;
  return folder / "shown.mp4";
}

TEST(VideoFile, IsSeenTurnedAsItSaysAndNeverUpsideDownBecauseItIsMirrored) {
  const auto path = support::real_data() / "flame/flame_shaken_1080p60.mp4";
  WISP_NEEDS(path);
  ScratchFolder folder("turned");
  constexpr int kX = 900, kY = 700;
  const auto first = [&](std::array<int, 4> matrix, int x, int y) {
    auto reader = VideoReader::open(shown_by(path, matrix, folder));
    const auto frame = reader->next();
    return static_cast<int>(plane_in_place((*frame)->picture, PixelChannel::kLuma).at(x, y));
  };
  auto plain = VideoReader::open(path);
  const auto frame = plain->next();
  const ImageView stored = plane_in_place((*frame)->picture, PixelChannel::kLuma);
  const int value = stored.at(kX, kY), right = stored.width - 1, bottom = stored.height - 1;
  ASSERT_NE(value, stored.at(right - kX, bottom - kY));
  EXPECT_EQ(first({0, 1, -1, 0}, bottom - kY, kX), value);
  EXPECT_EQ(first({-1, 0, 0, -1}, right - kX, bottom - kY), value);
  EXPECT_EQ(first({0, -1, 1, 0}, kY, right - kX), value);
  EXPECT_EQ(first({-1, 0, 0, 1}, kX, kY), value);                   // mirrored left to right: as it is
  EXPECT_EQ(first({1, 0, 0, -1}, right - kX, bottom - kY), value);  // upside down: turned
}

TEST(VideoFile, CutInHalfIsReadAsFarAsItGoesWithAWarning) {
  const auto path = support::real_data() / "flame/flame_shaken_1080p60.mp4";
  WISP_NEEDS(path);
  ScratchFolder folder("half");
  std::filesystem::copy_file(path, folder / "half.mp4");
  std::filesystem::permissions(folder / "half.mp4", std::filesystem::perms::owner_all);
  std::filesystem::resize_file(folder / "half.mp4", std::filesystem::file_size(path) / 2);
  auto reader = VideoReader::open(folder / "half.mp4");
  ASSERT_TRUE(reader) << reader.error().message;
  const std::size_t frames = see(*reader).index.size();
  EXPECT_GT(frames, 60u);
  EXPECT_LT(frames, 200u);
  ASSERT_FALSE(reader->warnings().empty());
  EXPECT_THAT(reader->warnings().back(), HasSubstr("cut off"));
}

}  // namespace
}  // namespace wisp::video_test
