#include "wisp/record/wav.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "paths.hpp"
#include "wisp/base/file.hpp"

namespace wisp::wav_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// A folder of this test's own, gone with it.
class Wav : public ::testing::Test {
 protected:
  Wav() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / (std::string("wisp-wav-") + test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~Wav() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path file(const std::string& name) const { return folder_ / name; }

  std::filesystem::path put(const std::string& name, const std::string& bytes) const {
    std::ofstream(file(name), std::ios::binary) << bytes;
    return file(name);
  }

  std::filesystem::path folder_;
};

std::string little(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i));
  return text;
}

std::string chunk(const std::string& id, const std::string& body) {
  return id + little(body.size(), 4) + body + (body.size() % 2 == 1 ? std::string(1, '\0') : "");
}

std::string format_chunk(unsigned tag, unsigned channels, unsigned rate, unsigned bits) {
  const unsigned frame = channels * bits / 8;
  return chunk("fmt ", little(tag, 2) + little(channels, 2) + little(rate, 4) + little(rate * frame, 4) +
                           little(frame, 2) + little(bits, 2));
}

std::string riff(const std::string& chunks) { return "RIFF" + little(4 + chunks.size(), 4) + "WAVE" + chunks; }

// An extensible file of three tracks of 24 bits.
std::string three_tracks(int samples) {
  const std::string identity("\x01\0\0\0\0\0\x10\0\x80\0\0\xaa\0\x38\x9b\x71", 16);
  const std::string format = little(0xfffe, 2) + little(3, 2) + little(44100, 4) + little(44100 * 9, 4) + little(9, 2) +
                             little(24, 2) + little(22, 2) + little(24, 2) + little(7, 4) + identity;
  return riff(chunk("fmt ", format) + chunk("data", std::string(static_cast<std::size_t>(3 * samples), '\x31')));
}

std::string error_of(const std::filesystem::path& path) {
  auto sound = read_wav(path);
  return sound ? "read" : sound.error().message;
}

TEST_F(Wav, PcmOf8BitsIsUnsigned) {
  const auto sound = read_wav(put("a.wav", riff(format_chunk(1, 1, 8000, 8) + chunk("data", "\x80\xff\x01"))));
  ASSERT_TRUE(sound) << sound.error().message;
  EXPECT_THAT(sound->samples, ElementsAre(0.0F, 127.0F / 128, -127.0F / 128));
}

TEST_F(Wav, PcmOf16BitsIsOver32768) {
  const auto sound = read_wav(put("a.wav", riff(format_chunk(1, 1, 8000, 16) +
                                                chunk("data", little(0x8000, 2) + little(0x7fff, 2) + little(1, 2)))));
  ASSERT_TRUE(sound) << sound.error().message;
  EXPECT_THAT(sound->samples, ElementsAre(-1.0F, 32767.0F / 32768, 1.0F / 32768));
}

TEST_F(Wav, PcmOf24And32BitsHasItsSign) {
  const auto three =
      read_wav(put("a.wav", riff(format_chunk(1, 1, 8000, 24) +
                                 chunk("data", little(0x800000, 3) + little(0xffffff, 3) + little(1, 3)))));
  ASSERT_TRUE(three) << three.error().message;
  EXPECT_THAT(three->samples, ElementsAre(-1.0F, -1.0F / 8388608, 1.0F / 8388608));
  const auto four = read_wav(
      put("b.wav", riff(format_chunk(1, 1, 8000, 32) + chunk("data", little(0x80000000U, 4) + little(0x40000000, 4)))));
  ASSERT_TRUE(four) << four.error().message;
  EXPECT_THAT(four->samples, ElementsAre(-1.0F, 0.5F));
}

TEST_F(Wav, FloatsAreTakenAsTheyAre) {
  const auto narrow = read_wav(
      put("a.wav", riff(format_chunk(3, 1, 8000, 32) + chunk("data", little(std::bit_cast<std::uint32_t>(1.5F), 4)))));
  ASSERT_TRUE(narrow) << narrow.error().message;
  EXPECT_THAT(narrow->samples, ElementsAre(1.5F));
  const auto wide = read_wav(
      put("b.wav", riff(format_chunk(3, 1, 8000, 64) + chunk("data", little(std::bit_cast<std::uint64_t>(-0.25), 8)))));
  ASSERT_TRUE(wide) << wide.error().message;
  EXPECT_THAT(wide->samples, ElementsAre(-0.25F));
}

TEST_F(Wav, OtherChunksArePassedOver) {
  const std::string junk = chunk("LIST", "odd") + chunk("bext", std::string(602, 'x'));
  const auto sound = read_wav(put("a.wav", riff(junk + format_chunk(1, 1, 8000, 16) + junk +
                                                chunk("data", little(16384, 2)) + chunk("id3 ", "tail"))));
  ASSERT_TRUE(sound) << sound.error().message;
  EXPECT_THAT(sound->samples, ElementsAre(0.5F));
}

TEST_F(Wav, AStreamsUnknownSizeRunsToTheEndOfTheFile) {
  const auto sound =
      read_wav(put("a.wav", "RIFF" + little(0xffffffffU, 4) + "WAVE" + format_chunk(1, 1, 8000, 16) + "data" +
                                little(0xffffffffU, 4) + little(16384, 2) + little(8192, 2) + "x"));
  ASSERT_TRUE(sound) << sound.error().message;
  EXPECT_THAT(sound->samples, ElementsAre(0.5F, 0.25F));
}

TEST_F(Wav, Rf64HasItsSizeInAChunkOfItsOwn) {
  const std::string sizes = chunk("ds64", little(0, 8) + little(4, 8) + little(2, 8) + little(0, 4));
  const auto sound =
      read_wav(put("a.wav", "RF64" + little(0xffffffffU, 4) + "WAVE" + sizes + format_chunk(1, 1, 8000, 16) + "data" +
                                little(0xffffffffU, 4) + little(16384, 2) + little(8192, 2) + "tail"));
  ASSERT_TRUE(sound) << sound.error().message;
  EXPECT_THAT(sound->samples, ElementsAre(0.5F, 0.25F));
}

TEST_F(Wav, ReadsInBlocksOfAnySize) {
  WavSound sound{{48000, 2, WavSample::kFloat32}, {}};
  std::string bytes;
  for (int i = 0; i < 50000; ++i) {
    sound.samples.push_back(static_cast<float>(i));
    bytes += little(std::bit_cast<std::uint32_t>(sound.samples.back()), 4);
  }
  put("a.wav", riff(format_chunk(3, 2, 48000, 32) + chunk("data", bytes)));
  for (const std::size_t size : {2U, 7U, 30000U, 200000U}) {
    auto reader = WavReader::open(file("a.wav"));
    ASSERT_TRUE(reader);
    EXPECT_EQ(reader->frames(), 25000U);
    std::vector<float> all;
    std::vector<float> block(size);
    for (;;) {
      const auto count = reader->read(block);
      ASSERT_TRUE(count);
      EXPECT_EQ(*count % 2, 0U);
      if (*count == 0) break;
      all.insert(all.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(*count));
    }
    EXPECT_EQ(all, sound.samples) << size;
  }
}

TEST_F(Wav, AFileWithoutSamplesIsShortAndFine) {
  const auto sound = read_wav(put("a.wav", riff(format_chunk(1, 2, 8000, 16) + chunk("data", ""))));
  ASSERT_TRUE(sound) << sound.error().message;
  EXPECT_TRUE(sound->samples.empty());
}

TEST_F(Wav, SaysThatAFileIsNoWav) {
  EXPECT_THAT(error_of(file("missing.wav")),
              AllOf(StartsWith(file("missing.wav").string()), HasSubstr("No such file")));
  EXPECT_THAT(error_of(folder_), HasSubstr("cannot be read"));
  EXPECT_THAT(error_of(put("a", "")), HasSubstr("not a WAV file: 0 bytes, expected at least a header of 44"));
  EXPECT_THAT(error_of(put("b", "ID3\x03 this is no sound")), HasSubstr("it starts with 'ID3.', expected 'RIFF'"));
  EXPECT_THAT(error_of(put("c", "RIFF" + little(4, 4) + "AVI ")), HasSubstr("of kind 'AVI ', expected 'WAVE'"));
}

TEST_F(Wav, SaysWhichCodingItCannotRead) {
  EXPECT_THAT(error_of(put("a", riff(format_chunk(85, 2, 44100, 16) + chunk("data", "")))),
              HasSubstr("sound coding 85 with 16 bits, expected PCM (1)"));
  EXPECT_THAT(error_of(put("b", riff(format_chunk(1, 1, 44100, 12) + chunk("data", "")))), HasSubstr("with 12 bits"));
  EXPECT_THAT(error_of(put("c", riff(format_chunk(1, 0, 44100, 16) + chunk("data", "")))), HasSubstr("0 channels"));
  EXPECT_THAT(error_of(put("d", riff(format_chunk(1, 1, 0, 16) + chunk("data", "")))), HasSubstr("a rate of 0 Hz"));
  const std::string strange =
      little(1, 2) + little(2, 2) + little(8000, 4) + little(0, 4) + little(7, 2) + little(16, 2);
  EXPECT_THAT(error_of(put("e", riff(chunk("fmt ", strange) + chunk("data", "")))),
              HasSubstr("7 bytes a frame, expected 4 for 2 channels of 16 bits"));
}

TEST_F(Wav, SaysWhenSizesAreWrong) {
  const std::string head = format_chunk(1, 2, 8000, 16);
  EXPECT_THAT(error_of(put("a", riff(head + "data" + little(400, 4) + std::string(100, 'x')))),
              HasSubstr("the header says 400 bytes of sound, the file has 100: it was cut off"));
  EXPECT_THAT(error_of(put("b", riff(head + chunk("data", "abcdef")))),
              HasSubstr("says 6 bytes of sound, expected a multiple of 4"));
  EXPECT_THAT(error_of(put("c", riff(chunk("fmt ", "short") + chunk("data", "")))),
              HasSubstr("5 bytes, expected at least 16"));
  EXPECT_THAT(error_of(put("d", riff("LIST" + little(1000, 4) + "abc"))),
              HasSubstr("chunk 'LIST' at byte 12 says 1000 bytes, the file has 3 left"));
  EXPECT_THAT(error_of(put("e", riff(head))), HasSubstr("without a 'data' chunk"));
  EXPECT_THAT(error_of(put("f", riff(chunk("data", "abcd") + head))), HasSubstr("the data comes before the format"));
}

TEST_F(Wav, EveryCutOfAFileIsReadOrRefusedAndNeverMore) {
  const std::string whole = three_tracks(6);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::string message = error_of(put("cut.wav", whole.substr(0, length)));
    EXPECT_THAT(message, StartsWith(file("cut.wav").string() + ": ")) << length;
    EXPECT_THAT(message, Not(HasSubstr("\n")));
  }
}

TEST_F(Wav, EveryWrongByteOfAHeaderIsReadOrRefused) {
  const std::string whole = three_tracks(3);
  for (std::size_t at = 0; at < 68; ++at) {
    for (const int value : {0, 1, 127, 128, 255}) {
      std::string wrong = whole;
      wrong[at] = static_cast<char>(value);
      const auto sound = read_wav(put("wrong.wav", wrong));
      if (sound) {
        EXPECT_LE(sound->samples.size(), whole.size());
      }
    }
  }
}

TEST_F(Wav, RealFilesAreRead) {
  const char* set = std::getenv("WISP_DATA");
  const std::filesystem::path data = set != nullptr ? set : std::string(WISP_SOURCE_DIR) + "/../shared/data";
  if (!std::filesystem::exists(data / "sound/breath_normal.wav")) GTEST_SKIP() << "no recordings in " << data;
  const auto breath = read_wav(data / "sound/breath_normal.wav");
  ASSERT_TRUE(breath) << breath.error().message;
  EXPECT_EQ(breath->format.rate_hz, 44100);
  EXPECT_NEAR(static_cast<double>(breath->samples.size()) / 44100, 19.99, 0.01);
}

}  // namespace
}  // namespace wisp::wav_test
