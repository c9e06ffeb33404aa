#pragma once
// Conversion of numbers to little-endian bytes, and hashes of these bytes, by which a saved bank identifies its model.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>

#include "base/hash.hpp"

namespace wisp {

/// Writes consecutive numbers. Precondition: `at` has room for them.
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

/// Reads consecutive numbers. Precondition: `at` holds them.
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

template <class Number>
inline std::uint64_t hash_number(Number number, std::uint64_t before) {
  std::byte bytes[sizeof(Number)];
  ByteWriter(bytes).put(number);
  return hash_bytes(bytes, before);
}

inline std::uint64_t hash_floats(std::span<const float> numbers, std::uint64_t before) {
  std::uint64_t hash = before;
  for (float number : numbers) hash = hash_number(number, hash);
  return hash;
}
inline std::uint64_t hash_floats(std::initializer_list<float> numbers, std::uint64_t before) {
  return hash_floats(std::span(numbers.begin(), numbers.size()), before);
}

}  // namespace wisp
