#pragma once
// Random words and normal deviates for the lanes of a block.

#include <array>
#include <cstdint>

#include "run/lanes.hpp"

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

/// Philox4x32: turns the counters in `words` into four random words a lane.
template <class N>
inline void philox(const RandomKeys& keys, typename N::Word (&words)[4][N::kLanes]) {
  for (const auto& key : keys) {
    for (int lane = 0; lane < N::kLanes; ++lane) {
      const auto a = wide_product(words[0][lane], 0xD2511F53U);
      const auto b = wide_product(words[2][lane], 0xCD9E8D57U);
      words[0][lane] = b.high ^ words[1][lane] ^ key[0];
      words[1][lane] = b.low;
      words[2][lane] = a.high ^ words[3][lane] ^ key[1];
      words[3][lane] = a.low;
    }
  }
}

/// What tells the lanes' random numbers apart: the instance's stream and how many steps it has lived.
struct LaneCounters {
  const std::uint64_t* stream;
  const std::uint64_t* age;
};

/// Random words of one group of four channels.
template <class N>
inline void random_group(const RandomKeys& keys, const LaneCounters& counters, std::uint32_t group,
                         typename N::Word (&words)[4][N::kLanes]) {
  for (int lane = 0; lane < N::kLanes; ++lane) {
    const std::uint64_t age = counters.age[lane];
    const std::uint64_t stream = counters.stream[lane];
    words[0][lane] = static_cast<std::uint32_t>(age);
    words[1][lane] = static_cast<std::uint32_t>(age >> 32) << 16 | group;
    words[2][lane] = static_cast<std::uint32_t>(stream);
    words[3][lane] = static_cast<std::uint32_t>(stream >> 32);
  }
  philox<N>(keys, words);
}

/// One segment of the inverse normal distribution; script/normal_table.py derives them.
struct NormalSegment {
  float c0, c1, c2;
};
inline constexpr NormalSegment kNormalSegments[] = {
#include "run/normal_table.inc"
};
inline constexpr std::uint32_t kFirstSegment = 126U << 4;  // the bits of 0.5f above the 19 lowest

/// Normal deviates of one word a lane: the inverse normal distribution at (word + ½) / 2³², by a quadratic on each of
/// 16 parts of every octave of the smaller tail. Error: 1.12e-6 by the quadratics, half a unit in the last place of c0
/// and of the result (2.4e-7 each at 6), together below 1.7e-6; the tests find the true maximum.
template <class N>
inline void normal_lanes(const typename N::Word (&words)[N::kLanes], typename N::Real* deviates) {
  using Real = typename N::Real;
  using Word = typename N::Word;
  Word sign[N::kLanes];
  Real place[N::kLanes], c0[N::kLanes], c1[N::kLanes], c2[N::kLanes];
  std::uint32_t segment[N::kLanes];
  for (int lane = 0; lane < N::kLanes; ++lane) {
    sign[lane] = spread_sign(words[lane]);
    const Word folded = words[lane] ^ sign[lane];
    const Word bits = bits_of(real_of(folded) + Real(0.5f));
    segment[lane] = plain(bits >> 19) - kFirstSegment;
    place[lane] = real_of(bits & 0x7ffffU);
  }
  for (int lane = 0; lane < N::kLanes; ++lane) {
    c0[lane] = kNormalSegments[segment[lane]].c0;
    c1[lane] = kNormalSegments[segment[lane]].c1;
    c2[lane] = kNormalSegments[segment[lane]].c2;
  }
  for (int lane = 0; lane < N::kLanes; ++lane) {
    const Real size = c0[lane] + place[lane] * (c1[lane] + place[lane] * c2[lane]);
    deviates[lane] = real_of_bits(bits_of(size) ^ (~sign[lane] & 0x80000000U));
  }
}

}  // namespace wisp
