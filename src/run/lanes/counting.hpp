#pragma once
// Number and word types that count the arithmetic done with them: kernels are instantiated with them to measure cost.

#include <cmath>
#include <cstdint>

#include "run/lanes/lanes.hpp"

namespace wisp {

/// Number of operations so far, on this thread.
struct OperationCount {
  std::int64_t numbers = 0;  ///< + − × ÷ √ and the change of sign
  std::int64_t words = 0;    ///< arithmetic, logic and shifts
};
inline thread_local OperationCount operation_count;

struct CountingReal {
  float value = 0;

  CountingReal() = default;
  explicit CountingReal(float number) : value(number) {}
};

inline CountingReal counted(float value) {
  ++operation_count.numbers;
  return CountingReal(value);
}
inline CountingReal operator+(CountingReal a, CountingReal b) { return counted(a.value + b.value); }
inline CountingReal operator-(CountingReal a, CountingReal b) { return counted(a.value - b.value); }
inline CountingReal operator*(CountingReal a, CountingReal b) { return counted(a.value * b.value); }
inline CountingReal operator/(CountingReal a, CountingReal b) { return counted(a.value / b.value); }
inline CountingReal operator-(CountingReal a) { return counted(-a.value); }
inline bool operator<(CountingReal a, CountingReal b) { return a.value < b.value; }
inline bool operator>(CountingReal a, CountingReal b) { return a.value > b.value; }
inline bool operator==(CountingReal a, CountingReal b) { return a.value == b.value; }

inline CountingReal square_root(CountingReal a) { return counted(std::sqrt(a.value)); }
inline CountingReal square_root_part(CountingReal a) { return square_root(a); }
inline float value_of(CountingReal a) { return a.value; }

struct CountingWord {
  std::uint32_t value = 0;

  CountingWord() = default;
  CountingWord(std::uint32_t word) : value(word) {}
};

inline CountingWord counted(std::uint32_t value) {
  ++operation_count.words;
  return {value};
}
inline CountingWord operator^(CountingWord a, CountingWord b) { return counted(a.value ^ b.value); }
inline CountingWord operator&(CountingWord a, CountingWord b) { return counted(a.value & b.value); }
inline CountingWord operator|(CountingWord a, CountingWord b) { return counted(a.value | b.value); }
inline CountingWord operator+(CountingWord a, CountingWord b) { return counted(a.value + b.value); }
inline CountingWord operator-(CountingWord a, CountingWord b) { return counted(a.value - b.value); }
inline CountingWord operator<<(CountingWord a, int bits) { return counted(a.value << bits); }

// Conversions and comparisons, as in lanes.hpp: not counted as arithmetic, unlike a signed shift and a wide product.

inline CountingReal real_of_part(CountingWord word) {
  return CountingReal(static_cast<float>(static_cast<std::int32_t>(word.value)));
}
inline CountingWord bits_of_part(CountingReal real) { return {std::bit_cast<std::uint32_t>(real.value)}; }
inline CountingWord whole_part(CountingReal real) { return {static_cast<std::uint32_t>(real.value)}; }
inline CountingReal next_part(CountingReal real) { return CountingReal(real.value + 1.0f); }
inline CountingReal real_of_bits_part(CountingWord bits) { return CountingReal(std::bit_cast<float>(bits.value)); }
template <int bits>
inline CountingWord signed_shift_part(CountingWord word) {
  return counted(static_cast<std::uint32_t>(static_cast<std::int32_t>(word.value) >> bits));
}
inline CountingWord differ_part(CountingReal a, CountingReal b) { return {a == b ? 0U : 0xffffffffU}; }
inline CountingReal magnitude_part(CountingReal a) { return CountingReal(std::fabs(a.value)); }
inline void columns_part(const float* const* row, std::size_t first, CountingReal (&column)[4]) {
  for (std::size_t k = 0; k < 4; ++k) column[k] = CountingReal(row[0][first + k]);
}
inline void columns_part(const CountingReal* const* row, std::size_t first, CountingReal (&column)[4]) {
  for (std::size_t k = 0; k < 4; ++k) column[k] = row[0][first + k];
}
inline void rows_part(const CountingReal (&column)[4], std::size_t first, CountingReal* const* row) {
  for (std::size_t k = 0; k < 4; ++k) row[0][first + k] = column[k];
}
inline void spread_part(float value, CountingReal& part) { part = CountingReal(value); }
inline void spread_part(std::uint32_t value, CountingWord& part) { part = {value}; }
inline WideProduct<CountingWord> wide_product_part(CountingWord a, std::uint32_t b) {
  const std::uint64_t product = static_cast<std::uint64_t>(a.value) * b;
  return {counted(static_cast<std::uint32_t>(product >> 32)), {static_cast<std::uint32_t>(product)}};
}

inline std::uint32_t value_of(CountingWord word) { return word.value; }

struct CountingNumbers {
  using Real = CountingReal;
  using Word = CountingWord;
  using RealPart = CountingReal;
  using WordPart = CountingWord;
  static constexpr int kLanes = 1;
  static constexpr int kPartLanes = 1;
  static constexpr int kParts = 1;
};

}  // namespace wisp
