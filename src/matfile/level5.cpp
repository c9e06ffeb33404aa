#include "level5.hpp"

#include <array>
#include <cstdint>
#include <fstream>

namespace wisp {
namespace {

constexpr std::uintmax_t kHeader = 128;
constexpr std::uintmax_t kTag = 8;

std::uint32_t number(const unsigned char* bytes, bool big) {
  std::uint32_t value = 0;
  for (int k = 0; k < 4; ++k) value |= std::uint32_t{bytes[big ? 3 - k : k]} << (8 * k);
  return value;
}

}  // namespace

bool level5_is_whole(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  std::ifstream stream(path, std::ios::binary);
  std::array<unsigned char, kHeader> header{};
  if (error || !stream.read(reinterpret_cast<char*>(header.data()), header.size())) return false;
  const bool big = header[126] == 'M' && header[127] == 'I';
  std::uintmax_t at = kHeader;
  while (at + kTag <= size) {
    std::array<unsigned char, kTag> tag{};
    stream.seekg(static_cast<std::streamoff>(at));
    if (!stream.read(reinterpret_cast<char*>(tag.data()), tag.size())) return false;
    at += kTag + number(tag.data() + 4, big);
  }
  return at == size;
}

}  // namespace wisp
