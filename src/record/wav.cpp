#include "wisp/record/wav.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/path_text.hpp"

namespace wisp {
namespace {

// Multimedia Programming Interface and Data Specifications 1.0 (RIFF WAVE), with WAVE_FORMAT_EXTENSIBLE and EBU Tech
// 3306 (RF64). All numbers are little-endian.
constexpr std::uint32_t kUnknownSize = 0xffffffffU;
constexpr unsigned kTagPcm = 1;
constexpr unsigned kTagFloat = 3;
constexpr unsigned kTagExtensible = 0xfffe;
constexpr std::size_t kBlockBytes = 1 << 16;

// The part of an extensible format's 16-byte identity that follows its tag.
constexpr std::array<unsigned char, 14> kSubformatTail{0x00, 0x00, 0x00, 0x00, 0x10, 0x00, 0x80,
                                                       0x00, 0x00, 0xaa, 0x00, 0x38, 0x9b, 0x71};

int bytes_of(WavSample sample) {
  switch (sample) {
    case WavSample::kPcm8:
      return 1;
    case WavSample::kPcm16:
      return 2;
    case WavSample::kPcm24:
      return 3;
    case WavSample::kPcm32:
    case WavSample::kFloat32:
      return 4;
    case WavSample::kFloat64:
      return 8;
  }
  return 2;
}

std::uint64_t little(const unsigned char* bytes, int count) {
  std::uint64_t value = 0;
  for (int i = count - 1; i >= 0; --i) value = (value << 8) | bytes[i];
  return value;
}

/// Four letters as they can be shown in a message.
std::string shown(const unsigned char* id) {
  std::string text = "'";
  for (int i = 0; i < 4; ++i) text += id[i] >= 32 && id[i] < 127 ? static_cast<char>(id[i]) : '.';
  return text + "'";
}

Error bad(const std::filesystem::path& path, const std::string& what) { return Error{path_text(path) + ": " + what}; }

std::optional<WavSample> sample_of(unsigned tag, unsigned bits) {
  if (tag == kTagPcm && bits == 8) return WavSample::kPcm8;
  if (tag == kTagPcm && bits == 16) return WavSample::kPcm16;
  if (tag == kTagPcm && bits == 24) return WavSample::kPcm24;
  if (tag == kTagPcm && bits == 32) return WavSample::kPcm32;
  if (tag == kTagFloat && bits == 32) return WavSample::kFloat32;
  if (tag == kTagFloat && bits == 64) return WavSample::kFloat64;
  return std::nullopt;
}

Result<WavFormat> parse_format(const std::filesystem::path& path, std::span<const unsigned char> chunk) {
  if (chunk.size() < 16) {
    return bad(path, "the format chunk has " + std::to_string(chunk.size()) + " bytes, expected at least 16");
  }
  unsigned tag = static_cast<unsigned>(little(chunk.data(), 2));
  const unsigned channels = static_cast<unsigned>(little(chunk.data() + 2, 2));
  const std::uint64_t rate = little(chunk.data() + 4, 4);
  const unsigned block = static_cast<unsigned>(little(chunk.data() + 12, 2));
  const unsigned bits = static_cast<unsigned>(little(chunk.data() + 14, 2));
  if (tag == kTagExtensible) {
    if (chunk.size() < 40) {
      return bad(path, "the extensible format chunk has " + std::to_string(chunk.size()) + " bytes, expected 40");
    }
    const bool known = std::equal(kSubformatTail.begin(), kSubformatTail.end(), chunk.begin() + 26);
    tag = known ? static_cast<unsigned>(little(chunk.data() + 24, 2)) : kTagExtensible;
  }
  const std::optional<WavSample> sample = sample_of(tag, bits);
  if (!sample) {
    return bad(path, "sound coding " + std::to_string(tag) + " with " + std::to_string(bits) +
                         " bits, expected PCM (1) of 8, 16, 24 or 32 bits or float (3) of 32 or 64; convert it, for "
                         "example: ffmpeg -i IN -c:a pcm_s16le OUT.wav");
  }
  if (channels == 0) return bad(path, "0 channels, expected at least 1");
  if (rate == 0) return bad(path, "a rate of 0 Hz, expected at least 1");
  const unsigned expected = channels * static_cast<unsigned>(bytes_of(*sample));
  if (block != expected) {
    return bad(path, std::to_string(block) + " bytes a frame, expected " + std::to_string(expected) + " for " +
                         std::to_string(channels) + " channels of " + std::to_string(bits) + " bits");
  }
  return WavFormat{static_cast<double>(rate), static_cast<int>(channels), *sample};
}

float decode(const unsigned char* at, WavSample sample) {
  switch (sample) {
    case WavSample::kPcm8:
      return static_cast<float>(static_cast<int>(*at) - 128) / 128.0F;
    case WavSample::kPcm16:
      return static_cast<float>(static_cast<std::int16_t>(little(at, 2))) / 32768.0F;
    case WavSample::kPcm24: {
      const std::int32_t value = static_cast<std::int32_t>(little(at, 3) << 8) / 256;
      return static_cast<float>(value) / 8388608.0F;
    }
    case WavSample::kPcm32:
      return static_cast<float>(static_cast<std::int32_t>(little(at, 4))) / 2147483648.0F;
    case WavSample::kFloat32:
      return std::bit_cast<float>(static_cast<std::uint32_t>(little(at, 4)));
    case WavSample::kFloat64:
      return static_cast<float>(std::bit_cast<double>(little(at, 8)));
  }
  return 0;
}

}  // namespace

struct WavReader::State {
  std::filesystem::path path;
  std::ifstream stream;
  std::uint64_t file_bytes = 0;
  WavFormat format;
  std::uint64_t frames = 0;
  std::uint64_t frames_read = 0;
  std::vector<unsigned char> block;

  bool fetch(unsigned char* to, std::size_t count) {
    stream.read(reinterpret_cast<char*>(to), static_cast<std::streamsize>(count));
    return static_cast<std::size_t>(stream.gcount()) == count;
  }

  Result<void> start();
  Result<void> read_chunks(bool wide);
  Result<void> take_data(std::uint64_t at, std::uint64_t said, bool open_ended);
};

Result<void> WavReader::State::start() {
  unsigned char head[12];
  if (file_bytes < 12 || !fetch(head, 12)) {
    return bad(path, "not a WAV file: " + std::to_string(file_bytes) + " bytes, expected at least a header of 44");
  }
  const bool wide = std::memcmp(head, "RF64", 4) == 0;
  if (!wide && std::memcmp(head, "RIFF", 4) != 0) {
    return bad(path, "not a WAV file: it starts with " + shown(head) + ", expected 'RIFF'");
  }
  if (std::memcmp(head + 8, "WAVE", 4) != 0) {
    return bad(path, "not a WAV file: a RIFF file of kind " + shown(head + 8) + ", expected 'WAVE'");
  }
  return read_chunks(wide);
}

Result<void> WavReader::State::read_chunks(bool wide) {
  std::uint64_t at = 12;
  std::optional<std::uint64_t> wide_size;
  bool format_known = false;
  unsigned char head[8];
  while (at + 8 <= file_bytes && fetch(head, 8)) {
    std::uint64_t size = little(head + 4, 4);
    at += 8;
    if (std::memcmp(head, "data", 4) == 0) {
      if (!format_known) return bad(path, "the data comes before the format chunk, expected 'fmt ' first");
      if (wide && wide_size && size == kUnknownSize) return take_data(at, *wide_size, false);
      return take_data(at, size, size == kUnknownSize);
    }
    if (size > file_bytes - at) {
      return bad(path, "chunk " + shown(head) + " at byte " + std::to_string(at - 8) + " says " + std::to_string(size) +
                           " bytes, the file has " + std::to_string(file_bytes - at) +
                           " left; it was cut off or is not a WAV file");
    }
    std::array<unsigned char, 40> body{};
    const std::size_t taken = static_cast<std::size_t>(std::min<std::uint64_t>(size, body.size()));
    if (!fetch(body.data(), taken)) return bad(path, "cannot be read at byte " + std::to_string(at));
    if (std::memcmp(head, "fmt ", 4) == 0) {
      auto parsed = parse_format(path, std::span(body).first(taken));
      if (!parsed) return parsed.error();
      format = *parsed;
      format_known = true;
    }
    if (std::memcmp(head, "ds64", 4) == 0 && taken >= 16) wide_size = little(body.data() + 8, 8);
    at += size + size % 2;
    stream.seekg(static_cast<std::streamoff>(at));
  }
  return bad(path, std::string("ends after ") + std::to_string(file_bytes) + " bytes without a " +
                       (format_known ? "'data'" : "'fmt '") + " chunk, expected sound");
}

Result<void> WavReader::State::take_data(std::uint64_t at, std::uint64_t said, bool open_ended) {
  const std::uint64_t there = file_bytes - at;
  const std::uint64_t frame = static_cast<std::uint64_t>(format.channels * bytes_of(format.sample));
  if (open_ended) said = there - there % frame;
  if (said > there) {
    return bad(path, "the header says " + std::to_string(said) + " bytes of sound, the file has " +
                         std::to_string(there) + ": it was cut off; copy or record it again");
  }
  if (said % frame != 0) {
    return bad(path, "the header says " + std::to_string(said) + " bytes of sound, expected a multiple of " +
                         std::to_string(frame) + " (one sample of every channel)");
  }
  frames = said / frame;
  block.resize(static_cast<std::size_t>(std::max<std::uint64_t>(kBlockBytes / frame, 1) * frame));
  return {};
}

WavReader::WavReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
WavReader::WavReader(WavReader&&) noexcept = default;
WavReader& WavReader::operator=(WavReader&&) noexcept = default;
WavReader::~WavReader() = default;

Result<WavReader> WavReader::open(const std::filesystem::path& path) {
  auto state = std::make_unique<State>();
  state->path = path;
  std::error_code failed;
  const auto size = std::filesystem::file_size(path, failed);
  if (failed) return bad(path, "cannot be read: " + failed.message());
  state->file_bytes = size;
  state->stream.open(path, std::ios::binary);
  if (!state->stream) return bad(path, "cannot be opened for reading");
  if (auto started = state->start(); !started) return started.error();
  return WavReader(std::move(state));
}

const WavFormat& WavReader::format() const { return state_->format; }

std::uint64_t WavReader::frames() const { return state_->frames; }

Result<std::size_t> WavReader::read(std::span<float> interleaved) {
  State& s = *state_;
  const std::size_t channels = static_cast<std::size_t>(s.format.channels);
  const std::size_t bytes = static_cast<std::size_t>(bytes_of(s.format.sample));
  std::size_t written = 0;
  while (written + channels <= interleaved.size() && s.frames_read < s.frames) {
    const std::uint64_t wanted =
        std::min<std::uint64_t>((interleaved.size() - written) / channels, s.frames - s.frames_read);
    const std::size_t count =
        static_cast<std::size_t>(std::min<std::uint64_t>(wanted, s.block.size() / (channels * bytes)));
    if (!s.fetch(s.block.data(), count * channels * bytes)) {
      return bad(s.path, "the sound ends or cannot be read after " + std::to_string(s.frames_read) + " of " +
                             std::to_string(s.frames) + " frames");
    }
    for (std::size_t i = 0; i < count * channels; ++i) {
      interleaved[written + i] = decode(s.block.data() + i * bytes, s.format.sample);
    }
    written += count * channels;
    s.frames_read += count;
  }
  return written;
}

Result<WavSound> read_wav(const std::filesystem::path& path) {
  auto reader = WavReader::open(path);
  if (!reader) return reader.error();
  WavSound sound;
  sound.format = reader->format();
  sound.samples.resize(static_cast<std::size_t>(reader->frames()) * static_cast<std::size_t>(sound.format.channels));
  auto count = reader->read(sound.samples);
  if (!count) return count.error();
  return sound;
}

}  // namespace wisp
