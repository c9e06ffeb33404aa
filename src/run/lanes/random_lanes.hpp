#pragma once
// Random words and normal deviates for the lanes of a block.

#include <array>
#include <cstdint>

#include "run/lanes/lanes.hpp"

namespace wisp {

inline constexpr int kPhiloxRounds = 7;

/// Round keys derived from a seed.
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

/// Philox4x32 (wisp/run/random.hpp): converts four counters per lane to four random words per lane.
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

template <class Part, int kParts>
inline void philox(const RandomKeys& keys, Pack<Part, kParts> (&words)[4]) {
  unrolled<kParts>(
      [&](auto i) { philox_part(keys, words[0].part[i], words[1].part[i], words[2].part[i], words[3].part[i]); });
}

/// Values that distinguish the lanes' random numbers: the instance's stream, and its age in steps (step − born).
struct LaneCounters {
  const std::uint64_t* stream;
  const std::uint64_t* born;  ///< the bank's step at which the instance was spawned or reset
  std::uint64_t step;         ///< the bank's step now
};

/// Returns the lanes' counters, for group 0.
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

/// Number of channels whose deviates come from one group of words.
inline constexpr int kGroupChannels = 8;

/// Draws the random words of one group. Precondition: group < 2^16.
template <class N>
inline void random_group(const RandomKeys& keys, const Words<N> (&counters)[4], std::uint32_t group,
                         Words<N> (&words)[4]) {
  unrolled<4>([&](auto k) { words[k] = counters[k]; });
  words[1] = words[1] ^ all<Words<N>>(group);
  philox(keys, words);
}

/// Scales a random word to a whole number below `count`.
inline std::uint32_t share_of(std::uint32_t word, std::uint32_t count) {
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(word) * count >> 32);
}

/// Returns the mode of the largest probability; `threshold`: cumulative probabilities as words.
inline std::uint32_t likeliest(const std::uint32_t* threshold, std::uint32_t modes) {
  std::uint32_t best = 0, most = threshold[0];
  for (std::uint32_t mode = 1; mode < modes; ++mode) {
    if (threshold[mode] - threshold[mode - 1] <= most) continue;
    most = threshold[mode] - threshold[mode - 1];
    best = mode;
  }
  return best;
}

/// Two standard normal deviates per lane.
template <class Values>
struct NormalPair {
  Values first, second;
};

/// Evaluates c[0] + x (c[1] + x (c[2] + …)).
template <class Values, std::size_t count>
WISP_UNROLLED inline Values polynomial(const Values& x, const float (&c)[count]) {
  auto sum = all<Values>(c[count - 1]);
  unrolled<static_cast<int>(count) - 1>([&](auto k) { sum = all<Values>(c[count - 2 - k]) + x * sum; });
  return sum;
}

/// Converts one word per lane to two independent normal deviates, by the polar form: a point in the plane in a
/// uniformly random direction, at distance √(−2 ln u) from the origin. Of the word, bits 0 to 19 are u, (k + ½) / 2²⁰;
/// 21 to 31 a direction of the right half plane, π (k + ½) / 2¹¹ with k from −1024 to 1023; bit 20 inverts it. −2 ln,
/// sine and cosine are replaced by the minimax polynomials of their degrees, with errors up to 3.0e-6, 6.0e-7 and
/// 6.8e-6; each deviate is within 4e-5 of the exact one, and their distribution within 1e-5. Source: G. E. P. Box & M.
/// E. Muller, A note on the generation of random normal deviates, Annals of Mathematical Statistics 29, 1958.
template <class Word, int kParts>
WISP_UNROLLED inline auto normal_lanes(const Pack<Word, kParts>& words) {
  using Bits = Pack<Word, kParts>;
  const auto whole = real_of(words & all<Bits>(0xfffffU));
  using Values = std::remove_const_t<decltype(whole)>;
  // u = 2^octave · (1 + place), where 1 + place is from √½ to √2.
  constexpr std::uint32_t kMiddle = 0x3f3504f3U;  // the bits of √½
  const auto bits = bits_of(whole + all<Values>(0.5f)) - all<Bits>(kMiddle + (20U << 23));
  const auto octave = real_of(signed_shift<23>(bits));
  const auto place = real_of_bits((bits & all<Bits>(0x7fffffU)) + all<Bits>(kMiddle)) - all<Values>(1.0f);
  constexpr float kLogarithm[] = {-2.00002551f, 0.999701023f, -0.664517462f, 0.509449303f, -0.446601391f, 0.28639704f};
  const auto size = square_root(all<Values>(-1.38629436f) * octave + place * polynomial<Values>(place, kLogarithm));
  const auto turned = real_of_bits(bits_of(size) ^ ((words << 11) & all<Bits>(0x80000000U)));
  const auto angle = real_of(signed_shift<21>(words)) + all<Values>(0.5f);
  const auto square = angle * angle;
  constexpr float kSine[] = {0.00153397559f, -6.015346e-10f, 7.0551869e-17f, -3.67027436e-24f};
  constexpr float kCosine[] = {0.999993324f, -1.17634249e-06f, 2.29720431e-13f, -1.65629298e-20f};
  return NormalPair<Values>{turned * polynomial<Values>(square, kCosine),
                            turned * (angle * polynomial<Values>(square, kSine))};
}

}  // namespace wisp
