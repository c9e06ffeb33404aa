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

/// Philox4x32: turns four counters a lane into four random words a lane.
template <class N>
inline void philox(const RandomKeys& keys, Words<N> (&words)[4]) {
  for (const auto& key : keys) {
    for (int i = 0; i < N::kParts; ++i) {
      const auto a = wide_product_part(words[0].part[i], 0xD2511F53U);
      const auto b = wide_product_part(words[2].part[i], 0xCD9E8D57U);
      words[0].part[i] = b.high ^ words[1].part[i] ^ key[0];
      words[1].part[i] = b.low;
      words[2].part[i] = a.high ^ words[3].part[i] ^ key[1];
      words[3].part[i] = a.low;
    }
  }
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
  for (int k = 0; k < 4; ++k) words[k] = load<Words<N>>(counters[k]);
}

/// Random words of one group of four channels.
template <class N>
inline void random_group(const RandomKeys& keys, const Words<N> (&counters)[4], std::uint32_t group,
                         Words<N> (&words)[4]) {
  for (int k = 0; k < 4; ++k) words[k] = counters[k];
  words[1] = words[1] ^ all<Words<N>>(group);
  philox<N>(keys, words);
}

/// One segment of the inverse normal distribution; tools/normal_table.py derives them.
struct NormalSegment {
  float c0, c1, c2;
};
inline constexpr NormalSegment kNormalSegments[] = {
#include "run/lanes/normal_table.inc"
};
inline constexpr std::uint32_t kFirstSegment = 126U << 4;  // the bits of 0.5f above the 19 lowest

/// Normal deviates of one word a lane: the inverse normal distribution at (word + ½) / 2³², by a quadratic on each of
/// 16 parts of every octave of the smaller tail. Error: 1.12e-6 by the quadratics, half a unit in the last place of c0
/// and of the result (2.4e-7 each at 6), together below 1.7e-6; the tests find the true maximum.
template <class N>
inline Reals<N> normal_lanes(const Words<N>& words) {
  const Words<N> sign = spread_sign(words);
  const Words<N> bits = bits_of(real_of(words ^ sign) + all<Reals<N>>(0.5f));
  std::uint32_t segment[N::kLanes];
  store(bits >> 19, segment);
  float c0[N::kLanes], c1[N::kLanes], c2[N::kLanes];
  for (int lane = 0; lane < N::kLanes; ++lane) {
    const NormalSegment& quadratic = kNormalSegments[segment[lane] - kFirstSegment];
    c0[lane] = quadratic.c0;
    c1[lane] = quadratic.c1;
    c2[lane] = quadratic.c2;
  }
  const Reals<N> place = real_of(bits & all<Words<N>>(0x7ffffU));
  const Reals<N> slope = load<Reals<N>>(c1) + place * load<Reals<N>>(c2);
  const Reals<N> lower = load<Reals<N>>(c0) + place * slope;
  return real_of_bits(bits_of(lower) ^ (sign & all<Words<N>>(0x80000000U)));
}

}  // namespace wisp
