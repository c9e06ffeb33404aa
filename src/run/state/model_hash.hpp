#pragma once
// Hashes of a compiled model, equal on every machine. They determine whether a saved bank belongs to the model.

#include <cstdint>
#include <initializer_list>
#include <span>

#include "base/hash.hpp"
#include "run/state/little_endian.hpp"

namespace wisp {

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
