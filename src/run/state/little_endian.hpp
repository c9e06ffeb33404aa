#pragma once
// Numbers as little-endian bytes on any machine.

#include <bit>
#include <cstddef>
#include <cstdint>

namespace wisp {

/// Writes consecutive numbers.
///
/// Precondition: there is room.
class ByteWriter {
 public:
  explicit ByteWriter(std::byte* at) : at_(at) {}

  void put(std::uint64_t value) { put_bytes(value, 8); }
  void put(std::uint32_t value) { put_bytes(value, 4); }
  void put(float value) { put(std::bit_cast<std::uint32_t>(value)); }

 private:
  void put_bytes(std::uint64_t value, int count) {
    for (int k = 0; k < count; ++k) *at_++ = static_cast<std::byte>(value >> (8 * k) & 0xff);
  }

  std::byte* at_;
};

/// Reads consecutive numbers.
///
/// Precondition: there are as many.
class ByteReader {
 public:
  explicit ByteReader(const std::byte* at) : at_(at) {}

  std::uint64_t get64() { return get_bytes(8); }
  std::uint32_t get32() { return static_cast<std::uint32_t>(get_bytes(4)); }
  float get_float() { return std::bit_cast<float>(get32()); }

 private:
  std::uint64_t get_bytes(int count) {
    std::uint64_t value = 0;
    for (int k = 0; k < count; ++k) value |= std::to_integer<std::uint64_t>(*at_++) << (8 * k);
    return value;
  }

  const std::byte* at_;
};

}  // namespace wisp
