#pragma once
// Files for tests: a folder that goes away, images, raw video and sound, written by hand; and where real recordings
// are.

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>

#include "capture/support/synthetic.hpp"
#include "paths.hpp"

namespace wisp::support {

/// A folder that is removed with its contents.
class ScratchFolder {
 public:
  explicit ScratchFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("wisp-" + name + "-" + std::to_string(::getpid()) + "-" + std::to_string(std::rand()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() { std::filesystem::remove_all(path_); }

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// A grey image in the PGM format.
inline void write_pgm(const std::filesystem::path& path, const Plane& plane) {
  std::ofstream out(path, std::ios::binary);
  out << "P5\n" << plane.width << ' ' << plane.height << "\n255\n";
  out.write(reinterpret_cast<const char*>(plane.pixels.data()), static_cast<std::streamsize>(plane.pixels.size()));
}

/// Raw video in the YUV4MPEG2 format: luma as given, no colour.
class RawVideo {
 public:
  RawVideo(const std::filesystem::path& path, int width, int height, int rate) : out_(path, std::ios::binary) {
    out_ << "YUV4MPEG2 W" << width << " H" << height << " F" << rate << ":1 Ip A1:1 C420jpeg\n";
  }
  void add(const Plane& plane) {
    out_ << "FRAME\n";
    out_.write(reinterpret_cast<const char*>(plane.pixels.data()), static_cast<std::streamsize>(plane.pixels.size()));
    const std::string colours(plane.pixels.size() / 2, '\x80');
    out_ << colours;
  }

 private:
  std::ofstream out_;
};

/// 16-bit WAV of interleaved samples.
inline void write_wav(const std::filesystem::path& path, int rate, int channels,
                      std::span<const std::int16_t> samples) {
  std::ofstream out(path, std::ios::binary);
  const auto put = [&](std::uint32_t value, int bytes) {
    for (int k = 0; k < bytes; ++k) out.put(static_cast<char>(value >> (8 * k) & 255));
  };
  const std::uint32_t size = static_cast<std::uint32_t>(2 * samples.size());
  out << "RIFF";
  put(36 + size, 4);
  out << "WAVEfmt ";
  put(16, 4);
  put(1, 2);
  put(static_cast<std::uint32_t>(channels), 2);
  put(static_cast<std::uint32_t>(rate), 4);
  put(static_cast<std::uint32_t>(2 * rate * channels), 4);
  put(static_cast<std::uint32_t>(2 * channels), 2);
  put(16, 2);
  out << "data";
  put(size, 4);
  for (const std::int16_t sample : samples) put(static_cast<std::uint16_t>(sample), 2);
}

/// Where the real recordings lie, by WISP_DATA or beside the project.
inline std::filesystem::path real_data() {
  const char* given = std::getenv("WISP_DATA");
  return given != nullptr ? std::filesystem::path(given) : std::filesystem::path(WISP_SOURCE_DIR) / "../shared/data";
}

}  // namespace wisp::support

/// Skips a test, saying so, where a real recording is absent.
#define WISP_NEEDS(path) \
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no recording at " << (path).string()
