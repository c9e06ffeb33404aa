#pragma once
// Random words and normal deviates for the lanes of a block.

#include <array>
#include <cstdint>

#include "run/lanes/lanes.hpp"

namespace wisp {

inline constexpr int kPhiloxRounds = 7;

/// The round keys of a seed.
using RandomKeys = std::array<std::array<std::uint32_t, 2>, kPhiloxRounds>;

inline RandomKeys random_keys(std::uint64_t seed) {
  RandomKeys keys;
  auto low = static_cast<std::uint32_t>(seed);
  auto high = static_cast<std::uint32_t>(seed >> 32);
  for (auto& key : keys) {
    key = {low, high};
    low += 0x9E3779B9U;
    high += 0xBB67AE85U;
  }
  return keys;
}

inline constexpr std::uint32_t kPhiloxFactors[] = {0xD2511F53U, 0xCD9E8D57U};

/// Philox4x32: turns four counters a lane into four random words a lane. Of one part:
template <class Part>
inline void philox_part(const RandomKeys& keys, Part& w0, Part& w1, Part& w2, Part& w3) {
  for (const auto& key : keys) {
    const auto a = wide_product_part(w0, kPhiloxFactors[0]), b = wide_product_part(w2, kPhiloxFactors[1]);
    w0 = b.high ^ w1 ^ key[0];
    w1 = b.low;
    w2 = a.high ^ w3 ^ key[1];
    w3 = a.low;
  }
}

#ifdef WISP_LONG_WORDS
inline void philox_part(const RandomKeys& keys, WordPart& w0, WordPart& w1, WordPart& w2, WordPart& w3) {
  LongWords l0 = long_words(w0), l1 = long_words(w1), l2 = long_words(w2), l3 = long_words(w3);
  for (const auto& key : keys) {
    const LongWords a = product(l0, kPhiloxFactors[0]), b = product(l2, kPhiloxFactors[1]);
    l0 = differing(high_half(b), l1, key[0]);
    l1 = b;
    l2 = differing(high_half(a), l3, key[1]);
    l3 = a;
  }
  w0 = words_of(l0);
  w1 = words_of(l1);
  w2 = words_of(l2);
  w3 = words_of(l3);
}
#endif

template <class N>
inline void philox(const RandomKeys& keys, Words<N> (&words)[4]) {
  unrolled<N::kParts>(
      [&](auto i) { philox_part(keys, words[0].part[i], words[1].part[i], words[2].part[i], words[3].part[i]); });
}

/// What tells the lanes' random numbers apart: the instance's stream, and how many steps it has lived.
struct LaneCounters {
  const std::uint64_t* stream;
  const std::uint64_t* born;  ///< the bank's step when the life began
  std::uint64_t step;         ///< the bank's step now
};

/// The lanes' counters, for group 0.
template <class N>
inline void random_counters(const LaneCounters& lanes, Words<N> (&words)[4]) {
  std::uint32_t counters[4][N::kLanes];
  for (int lane = 0; lane < N::kLanes; ++lane) {
    const std::uint64_t age = lanes.step - lanes.born[lane];
    counters[0][lane] = static_cast<std::uint32_t>(age);
    counters[1][lane] = static_cast<std::uint32_t>(age >> 32) << 16;
    counters[2][lane] = static_cast<std::uint32_t>(lanes.stream[lane]);
    counters[3][lane] = static_cast<std::uint32_t>(lanes.stream[lane] >> 32);
  }
  unrolled<4>([&](auto k) { words[k] = load<Words<N>>(counters[k]); });
}

/// The counters of one lane in every lane, for group 0.
template <class N>
inline void random_counters_of(const LaneCounters& lanes, int lane, Words<N> (&words)[4]) {
  const std::uint64_t age = lanes.step - lanes.born[lane], stream = lanes.stream[lane];
  words[0] = all<Words<N>>(static_cast<std::uint32_t>(age));
  words[1] = all<Words<N>>(static_cast<std::uint32_t>(age >> 32) << 16);
  words[2] = all<Words<N>>(static_cast<std::uint32_t>(stream));
  words[3] = all<Words<N>>(static_cast<std::uint32_t>(stream >> 32));
}

/// Random words of one group of four channels.
template <class N>
inline void random_group(const RandomKeys& keys, const Words<N> (&counters)[4], std::uint32_t group,
                         Words<N> (&words)[4]) {
  unrolled<4>([&](auto k) { words[k] = counters[k]; });
  words[1] = words[1] ^ all<Words<N>>(group);
  philox<N>(keys, words);
}

#ifdef __wasm__
inline constexpr int kSegmentStride = 3;  // a page fetches the table before it plays
#else
inline constexpr int kSegmentStride = 4;  // so that a segment's place is a shift
#endif

/// One segment of the inverse normal distribution, a quadratic's three coefficients; tools/normal_table.py derives
/// them.
struct NormalSegment {
  float c[kSegmentStride];
};
inline constexpr NormalSegment kNormalSegments[] = {
#include "run/lanes/normal_table.inc"
    {0, 0, 0},  // segments are read four numbers at a time
};
inline constexpr std::uint32_t kFirstSegment = 126U << 4;  // the bits of 0.5f above the 19 lowest

/// Normal deviates of one word a lane: the inverse normal distribution at (word + ½) / 2³², by a quadratic on each of
/// 16 parts of every octave of the smaller tail. Error: 1.12e-6 by the quadratics, half a unit in the last place of c0
/// and of the result (2.4e-7 each at 6), together below 1.7e-6; the tests find the true maximum.
template <class Word, int kParts>
inline auto normal_lanes(const Pack<Word, kParts>& words) {
  const auto sign = spread_sign(words);
  const auto whole = real_of(words ^ sign);
  using Values = std::remove_const_t<decltype(whole)>;
  const auto bits = bits_of(whole + all<Values>(0.5f));
  const auto segment = bits >> 19;
  Values c[3];
  unrolled<kParts>([&](auto i) {
    columns_of_part<kSegmentStride, kFirstSegment>(kNormalSegments[0].c, segment.part[i], c[0].part[i], c[1].part[i],
                                                   c[2].part[i]);
  });
  using Bits = Pack<Word, kParts>;
  const Values place = real_of(bits & all<Bits>(0x7ffffU));
  const Values slope = c[1] + place * c[2];
  const Values lower = c[0] + place * slope;
  return real_of_bits(bits_of(lower) ^ (sign & all<Bits>(0x80000000U)));
}

}  // namespace wisp
