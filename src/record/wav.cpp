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
#include "wisp/base/file.hpp"

namespace wisp {
namespace {

// Multimedia Programming Interface and Data Specifications 1.0 (RIFF WAVE), with WAVE_FORMAT_EXTENSIBLE and EBU Tech
// 3306 (RF64). All numbers are little-endian.
constexpr std::uint32_t kUnknownSize = 0xffffffffU;
constexpr unsigned kTagPcm = 1;
constexpr unsigned kTagFloat = 3;
constexpr unsigned kTagExtensible = 0xfffe;
constexpr std::size_t kBlockBytes = 1 << 16;
constexpr std::uint64_t kMaxDataBytes = 0xffffffffU - 128;  // leaves room for the header in RIFF's 32-bit size

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

bool is_float(WavSample sample) { return sample == WavSample::kFloat32 || sample == WavSample::kFloat64; }

std::uint64_t little(const unsigned char* bytes, int count) {
  std::uint64_t value = 0;
  for (int i = count - 1; i >= 0; --i) value = (value << 8) | bytes[i];
  return value;
}

void put_little(std::uint64_t value, int count, std::vector<unsigned char>& out) {
  for (int i = 0; i < count; ++i) out.push_back(static_cast<unsigned char>(value >> (8 * i)));
}

void put_text(std::string_view text, std::vector<unsigned char>& out) {
  for (const char letter : text) out.push_back(static_cast<unsigned char>(letter));
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

std::int64_t quantized(float x, double scale) {
  if (std::isnan(x)) return 0;
  const double scaled = std::floor(static_cast<double>(x) * scale + 0.5);
  return static_cast<std::int64_t>(std::clamp(scaled, -scale, scale - 1));
}

void encode(float x, WavSample sample, std::vector<unsigned char>& out) {
  switch (sample) {
    case WavSample::kPcm8:
      return put_little(static_cast<std::uint64_t>(quantized(x, 128) + 128), 1, out);
    case WavSample::kPcm16:
      return put_little(static_cast<std::uint64_t>(quantized(x, 32768)), 2, out);
    case WavSample::kPcm24:
      return put_little(static_cast<std::uint64_t>(quantized(x, 8388608)), 3, out);
    case WavSample::kPcm32:
      return put_little(static_cast<std::uint64_t>(quantized(x, 2147483648.0)), 4, out);
    case WavSample::kFloat32:
      return put_little(std::bit_cast<std::uint32_t>(x), 4, out);
    case WavSample::kFloat64:
      return put_little(std::bit_cast<std::uint64_t>(static_cast<double>(x)), 8, out);
  }
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

Result<Recording> read_wav_recording(const std::filesystem::path& path) {
  auto sound = read_wav(path);
  if (!sound) return sound.error();
  Recording recording;
  recording.source = path_text(path);
  recording.rate_hz = sound->format.rate_hz;
  const std::size_t channels = static_cast<std::size_t>(sound->format.channels);
  const std::size_t rows = sound->samples.size() / channels;
  for (std::size_t c = 0; c < channels; ++c) {
    Channel channel;
    channel.name = channels == 1 ? "sound" : "sound." + std::to_string(c);
    channel.role = Role::kInput;
    channel.samples.reserve(rows);
    for (std::size_t row = 0; row < rows; ++row) {
      const float x = sound->samples[row * channels + c];
      if (!std::isfinite(x)) {
        return bad(path, "sample " + std::to_string(row + 1) + " of channel " + std::to_string(c + 1) +
                             " is not a finite number");
      }
      channel.samples.push_back(static_cast<double>(x));
    }
    recording.channels.push_back(std::move(channel));
  }
  return recording;
}

struct WavWriter::State {
  explicit State(PendingFile file) : pending(std::move(file)) {}

  std::filesystem::path path;
  PendingFile pending;
  std::ofstream stream;
  WavFormat format;
  std::uint64_t data_bytes = 0;
  std::vector<unsigned char> block;

  std::vector<unsigned char> header() const;
  Result<void> put(const std::vector<unsigned char>& bytes) {
    stream.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (!stream) return bad(path, "cannot be written: is the disk full?");
    return {};
  }
};

std::vector<unsigned char> WavWriter::State::header() const {
  const int bytes = bytes_of(format.sample);
  const unsigned tag = is_float(format.sample) ? kTagFloat : kTagPcm;
  const bool extensible = format.channels > 2;
  const std::uint64_t rate = static_cast<std::uint64_t>(format.rate_hz);
  const std::uint64_t frame = static_cast<std::uint64_t>(bytes * format.channels);
  std::vector<unsigned char> chunk;
  put_little(extensible ? kTagExtensible : tag, 2, chunk);
  put_little(static_cast<std::uint64_t>(format.channels), 2, chunk);
  put_little(rate, 4, chunk);
  put_little(std::min<std::uint64_t>(rate * frame, 0xffffffffU), 4, chunk);
  put_little(frame, 2, chunk);
  put_little(static_cast<std::uint64_t>(8 * bytes), 2, chunk);
  if (extensible) {
    put_little(22, 2, chunk);
    put_little(static_cast<std::uint64_t>(8 * bytes), 2, chunk);
    put_little(0, 4, chunk);  // no loudspeaker positions
    put_little(tag, 2, chunk);
    chunk.insert(chunk.end(), kSubformatTail.begin(), kSubformatTail.end());
  }
  std::vector<unsigned char> all;
  put_text("RIFF", all);
  put_little(4 + 8 + chunk.size() + 8 + data_bytes + data_bytes % 2, 4, all);
  put_text("WAVEfmt ", all);
  put_little(chunk.size(), 4, all);
  all.insert(all.end(), chunk.begin(), chunk.end());
  put_text("data", all);
  put_little(data_bytes, 4, all);
  return all;
}

WavWriter::WavWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
WavWriter::WavWriter(WavWriter&&) noexcept = default;
WavWriter& WavWriter::operator=(WavWriter&&) noexcept = default;
WavWriter::~WavWriter() = default;

Result<WavWriter> WavWriter::create(const std::filesystem::path& path, const WavFormat& format) {
  if (!(format.rate_hz >= 1 && format.rate_hz <= 4294967295.0) || format.rate_hz != std::floor(format.rate_hz)) {
    return bad(path, "a rate of " + std::to_string(format.rate_hz) + " Hz cannot be written, expected a whole number");
  }
  if (format.channels < 1 || format.channels * bytes_of(format.sample) > 65535) {
    return bad(path, std::to_string(format.channels) + " channels cannot be written, expected 1 to 8191");
  }
  auto pending = PendingFile::create(path);
  if (!pending) return pending.error();
  auto state = std::make_unique<State>(std::move(*pending));
  state->path = path;
  state->format = format;
  state->stream.open(state->pending.path(), std::ios::binary | std::ios::trunc);
  if (!state->stream) return bad(path, "cannot be opened for writing");
  if (auto ok = state->put(state->header()); !ok) return ok.error();
  return WavWriter(std::move(state));
}

Result<void> WavWriter::write(std::span<const float> interleaved) {
  State& s = *state_;
  const std::size_t bytes = static_cast<std::size_t>(bytes_of(s.format.sample));
  if (s.data_bytes + interleaved.size() * bytes > kMaxDataBytes) {
    return bad(s.path, "would grow past 4 GiB, the most that WAV holds; write several files");
  }
  while (!interleaved.empty()) {
    const std::size_t count = std::min(interleaved.size(), kBlockBytes / bytes);
    s.block.clear();
    for (const float x : interleaved.first(count)) encode(x, s.format.sample, s.block);
    if (auto ok = s.put(s.block); !ok) return ok;
    s.data_bytes += count * bytes;
    interleaved = interleaved.subspan(count);
  }
  return {};
}

Result<void> WavWriter::commit() {
  State& s = *state_;
  if (s.data_bytes % 2 == 1) {
    if (auto ok = s.put({0}); !ok) return ok;
  }
  s.stream.seekp(0);
  if (auto ok = s.put(s.header()); !ok) return ok;
  s.stream.close();
  if (!s.stream) return bad(s.path, "cannot be written: is the disk full?");
  return s.pending.commit();
}

Result<void> write_wav(const std::filesystem::path& path, const WavSound& sound) {
  auto writer = WavWriter::create(path, sound.format);
  if (!writer) return writer.error();
  if (auto ok = writer->write(sound.samples); !ok) return ok;
  return writer->commit();
}

}  // namespace wisp
